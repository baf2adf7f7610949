#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/model/scene.hpp"

// Small documents for tests: a square that rises, one metre a keyframe.

namespace tweend::test {

/// A unit square of two triangles. Each call makes a mesh of its own: equal content, another pointer.
inline model::MeshPtr square_mesh() { return *model::Mesh::make(4, {0, 1, 2, 0, 2, 3}); }

/// The square at a height, metres.
inline model::VertexKeyPtr square_at(const model::Mesh& mesh, float height) {
  const std::array<float, 12> positions{0, height, 0, 0, height, 1, 1, height, 1, 1, height, 0};
  return *model::VertexKey::make(mesh, positions);
}

struct ClipParts {
  std::string name = "default";
  std::size_t keys = 3;
  double spacing_s = 1.0;
  bool closed = false;
  model::KeyframeId first_id = 1;
};

/// Keyframe i stands at i × spacing and shows the square at i metres.
inline model::ClipPtr rising_clip(const model::Mesh& mesh, const ClipParts& parts = {}) {
  auto clip = std::make_shared<model::Clip>();
  clip->name = parts.name;
  clip->settings.closed = parts.closed;
  for (std::size_t i = 0; i < parts.keys; ++i) {
    clip->times_s.push_back(parts.spacing_s * static_cast<double>(i));
    clip->keyframes.push_back(
        {parts.first_id + static_cast<model::KeyframeId>(i), {}, {}, square_at(mesh, static_cast<float>(i))});
  }
  return clip;
}

/// An actor with one clip for each of `clips`, on a mesh of its own.
inline model::ActorPtr square_actor(std::string name, const std::vector<ClipParts>& clips = {ClipParts{}}) {
  auto actor = std::make_shared<model::Actor>();
  actor->name = std::move(name);
  actor->source = "mesh";
  const model::MeshPtr mesh = square_mesh();
  actor->model = std::make_shared<const model::Model>(model::Model{mesh, square_at(*mesh, 0.0F), {}, {}, {}});
  for (const ClipParts& parts : clips) actor->clips.push_back(rising_clip(*mesh, parts));
  return actor;
}

/// Settings that differ from the usual in one thing.
inline model::SceneSettings with_ambient(float ambient) {
  model::SceneSettings settings;
  settings.light.ambient = ambient;
  return settings;
}
inline model::SceneSettings with_grid(bool grid) {
  model::SceneSettings settings;
  settings.grid = grid;
  return settings;
}
inline model::ActorSettings with_visible(bool visible) {
  model::ActorSettings settings;
  settings.visible = visible;
  return settings;
}
inline model::ActorSettings with_spin(double spin_rad_s) {
  model::ActorSettings settings;
  settings.spin_rad_s = spin_rad_s;
  return settings;
}
inline model::ClipSettings with_closed(bool closed, std::optional<double> duration_s = {}) {
  model::ClipSettings settings;
  settings.closed = closed;
  settings.duration_s = duration_s;
  return settings;
}

inline model::ScenePtr scene_of(std::string name, std::vector<model::ActorPtr> actors = {}) {
  auto scene = std::make_shared<model::Scene>();
  scene->name = std::move(name);
  for (const model::ActorPtr& actor : actors) {
    for (const model::ClipPtr& clip : actor->clips) {
      for (const model::Keyframe& k : clip->keyframes) scene->next_keyframe = std::max(scene->next_keyframe, k.id + 1);
    }
  }
  scene->actors = std::move(actors);
  return scene;
}

}  // namespace tweend::test
