#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/model/actor.hpp"

// Small actors with skeletons: a ribbon of three joints that bends, and swells by two morph targets.

namespace tweend::test {

inline constexpr std::size_t kRibbonRows = 7;
inline constexpr std::size_t kRibbonJoints = 3;

/// Three joints in a row upwards, half a metre apart.
inline model::SkeletonPtr ribbon_skeleton() {
  const animation::JointPose up{.translation = {0.0F, 0.5F, 0.0F}};
  return *model::Skeleton::make({{"root", -1, {}}, {"middle", 0, up}, {"tip", 1, up}});
}

struct RibbonParts {
  bool skinned = true;
  bool morphed = true;
};

/// A ribbon of kRibbonRows rows of two vertices, 1.5 m high.
inline model::ModelPtr ribbon_model(const RibbonParts& parts = {}) {
  std::vector<float> positions, weights, wider, forward;
  std::vector<std::uint16_t> entries;
  std::vector<std::uint32_t> indices;
  for (std::size_t row = 0; row < kRibbonRows; ++row) {
    const float up = 1.5F * static_cast<float>(row) / (kRibbonRows - 1), along = std::min(up / 0.5F, 1.999F);
    const auto joint = static_cast<std::uint16_t>(along);
    const float share = along - std::floor(along);
    for (const float side : {-0.3F, 0.3F}) {
      positions.insert(positions.end(), {side, up, 0.0F});
      entries.insert(entries.end(), {joint, static_cast<std::uint16_t>(joint + 1), 0, 0});
      weights.insert(weights.end(), {1.0F - share, share, 0.0F, 0.0F});
      wider.insert(wider.end(), {side, 0.0F, 0.0F});
      forward.insert(forward.end(), {0.0F, 0.0F, up});
    }
    const auto at = static_cast<std::uint32_t>(2 * row);
    if (row + 1 < kRibbonRows) indices.insert(indices.end(), {at, at + 1, at + 3, at, at + 3, at + 2});
  }
  const std::size_t vertices = positions.size() / 3;
  auto model = std::make_shared<model::Model>();
  model->mesh = *model::Mesh::make(vertices, indices);
  model->rest = *model::VertexKey::make(*model->mesh, positions);
  model->skeleton = ribbon_skeleton();
  if (parts.skinned) {
    std::vector<model::SkinEntry> palette(kRibbonJoints);
    for (std::uint32_t j = 0; j < kRibbonJoints; ++j) {
      palette[j].joint = j;
      palette[j].joint_from_mesh.rows[1].w = -0.5F * static_cast<float>(j);
    }
    model->skin = *model::Skin::make(palette, 4, entries, weights, positions);
  }
  if (parts.morphed) {
    std::vector<model::MorphTarget> targets(2);
    targets[0].name = "wider";
    targets[0].positions = wider;
    targets[1].name = "forward";
    targets[1].positions = forward;
    model->morphs = *model::MorphTargets::make(std::move(targets), vertices);
  }
  return model;
}

/// A clip of a second that bends both upper joints about +Z and moves both weights.
inline model::ClipPtr bending_clip(const model::Model& model, std::string name, float angle) {
  using animation::Property;
  auto clip = std::make_shared<model::Clip>();
  clip->name = std::move(name);
  for (const float u : {0.0F, 1.0F}) {
    const float half = 0.5F * u * angle;
    std::vector<model::KeyedValue> values;
    for (const std::uint32_t joint : {1U, 2U}) {
      values.push_back({{joint, Property::Rotation}, {0.0F, 0.0F, std::sin(half), std::cos(half)}});
    }
    for (std::uint32_t w = 0; w < model.weight_count(); ++w) {
      values.push_back({{w, Property::Weight}, {u * (0.4F + 0.3F * static_cast<float>(w)), 0.0F, 0.0F, 0.0F}});
    }
    clip->times_s.push_back(u);
    model::Keyframe keyframe;
    keyframe.id = static_cast<model::KeyframeId>(1.0F + u);
    keyframe.pose = std::make_shared<const model::PoseKey>(std::move(values));
    clip->keyframes.push_back(std::move(keyframe));
  }
  return clip;
}

/// A clip of vertices, a keyframe a second: the rest shape moved sideways, keyframe i by `step` × (i + 1) metres.
inline model::ClipPtr sliding_clip(const model::Model& model, std::string name, std::size_t keys, float step) {
  auto clip = std::make_shared<model::Clip>();
  clip->name = std::move(name);
  for (std::size_t i = 0; i < keys; ++i) {
    std::vector<float> positions(model.rest->positions().begin(), model.rest->positions().end());
    for (std::size_t v = 0; v < positions.size(); v += 3) {
      positions[v] += step * static_cast<float>(i + 1);
      positions[v + 2] += 0.2F * step * static_cast<float>(i) * positions[v + 1];
    }
    clip->times_s.push_back(static_cast<double>(i));
    model::Keyframe keyframe;
    keyframe.id = static_cast<model::KeyframeId>(10 + i);
    keyframe.vertices = *model::VertexKey::make(*model.mesh, positions);
    clip->keyframes.push_back(std::move(keyframe));
  }
  return clip;
}

/// The ribbon with clips "bend", "twist" (skeletal), "slide" and "drift" (vertices).
inline std::shared_ptr<model::Actor> ribbon_actor(std::string name, const RibbonParts& parts = {}) {
  auto actor = std::make_shared<model::Actor>();
  actor->name = std::move(name);
  actor->source = "mesh";
  actor->model = ribbon_model(parts);
  const model::Model& model = *actor->model;
  actor->clips = {bending_clip(model, "bend", 0.9F), bending_clip(model, "twist", -1.4F), sliding_clip(model, "slide", 3, 0.4F),
                  sliding_clip(model, "drift", 5, -0.3F)};
  return actor;
}

/// A skeleton without a mesh.
inline std::shared_ptr<model::Actor> bones_actor(std::string name, std::vector<model::Joint> joints) {
  auto actor = std::make_shared<model::Actor>();
  actor->name = std::move(name);
  actor->source = "skeleton";
  auto model = std::make_shared<model::Model>();
  model->skeleton = *model::Skeleton::make(std::move(joints));
  actor->model = std::move(model);
  auto clip = std::make_shared<model::Clip>();
  clip->name = "default";
  actor->clips = {std::move(clip)};
  return actor;
}

}  // namespace tweend::test
