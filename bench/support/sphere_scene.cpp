#include "bench/support/sphere_scene.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "bench/support/server_process.hpp"

namespace tweend::bench {
namespace {

constexpr float kRadius = 3.0F;  // metres: most of the height that the default camera sees

model::VertexKeyPtr make_key(const model::Mesh& mesh, const std::vector<float>& positions) {
  auto key = model::VertexKey::make(mesh, positions);
  if (!key) give_up(key.error().message);
  return *key;
}

}  // namespace

std::vector<std::uint32_t> SphereGrid::indices() const {
  std::vector<std::uint32_t> indices;
  const std::uint32_t row = 2 * rings + 1;
  for (std::uint32_t y = 0; y < rings; ++y) {
    for (std::uint32_t x = 0; x + 1 < row; ++x) {
      const std::uint32_t a = y * row + x, b = a + 1, c = a + row, d = c + 1;
      indices.insert(indices.end(), {a, c, b, b, c, d});
    }
  }
  return indices;
}

std::vector<float> SphereGrid::positions(float lobes) const {
  constexpr float kPi = std::numbers::pi_v<float>;
  std::vector<float> positions;
  for (std::uint32_t y = 0; y <= rings; ++y) {
    for (std::uint32_t x = 0; x <= 2 * rings; ++x) {
      const float polar = kPi * static_cast<float>(y) / static_cast<float>(rings);
      const float azimuth = kPi * static_cast<float>(x) / static_cast<float>(rings);
      const float radius = kRadius * (1.0F + lobes * std::sin(4.0F * polar) * std::sin(5.0F * azimuth));
      positions.insert(positions.end(), {radius * std::sin(polar) * std::sin(azimuth), radius * std::cos(polar),
                                         radius * std::sin(polar) * std::cos(azimuth)});
    }
  }
  return positions;
}

stage::SceneViewPtr playing_sphere(const SphereGrid& grid) {
  const std::vector<float> sphere = grid.positions(0.0F);
  auto mesh = model::Mesh::make(sphere.size() / 3, grid.indices());
  if (!mesh) give_up(mesh.error().message);
  auto clip = std::make_shared<model::Clip>();
  clip->name = "default";
  clip->times_s = {0.0, 1.0};
  clip->keyframes = {{1, {}, {}, make_key(**mesh, sphere)}, {2, {}, {}, make_key(**mesh, grid.positions(0.2F))}};
  auto actor = std::make_shared<model::Actor>();
  actor->name = "sphere";
  actor->source = "mesh";
  actor->model = std::make_shared<const model::Model>(model::Model{*mesh, clip->keyframes.front().vertices, {}, {}, {}});
  actor->clips = {clip};
  auto scene = std::make_shared<model::Scene>();
  scene->name = "main";
  scene->next_keyframe = 3;
  scene->actors = {std::move(actor)};
  stage::Player player;
  player.actor = "sphere";
  player.clip = "default";
  player.playing = true;
  player.loop = stage::Loop::PingPong;
  return std::make_shared<const stage::SceneView>(
      stage::SceneView{std::move(scene), std::make_shared<const stage::Players>(1, std::move(player)), 1});
}

}  // namespace tweend::bench
