#include "bench/support/moving_meshes.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>

#include "bench/support/server_process.hpp"
#include "server/assets/asset_library.hpp"
#include "server/model/evaluate.hpp"

namespace tweend::bench {
namespace {

constexpr double kFramesPerSecond = 60.0;
constexpr double kBegin = 1.0;  ///< seconds: not where everything begins to move

using Point = std::array<double, 3>;
using Surface = std::function<Point(double u, double v)>;

/// Rows × columns of a surface, u and v from 0 to 1, with normals by differences.
MovingMesh::Frame sampled(const Surface& surface, std::size_t rows, std::size_t columns, double last_v) {
  constexpr double kNear = 1e-5;
  MovingMesh::Frame frame;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const double u = static_cast<double>(row) / static_cast<double>(rows - 1);
      const double v = last_v * static_cast<double>(column) / static_cast<double>(columns - 1);
      for (const double x : surface(u, v)) frame.positions.push_back(static_cast<float>(x));
      const Point u0 = surface(u - kNear, v), u1 = surface(u + kNear, v), v0 = surface(u, v - kNear),
                  v1 = surface(u, v + kNear);
      const auto a = [&](std::size_t k) { return v1[k] - v0[k]; };
      const auto b = [&](std::size_t k) { return u1[k] - u0[k]; };
      const Point n{a(1) * b(2) - a(2) * b(1), a(2) * b(0) - a(0) * b(2), a(0) * b(1) - a(1) * b(0)};
      const double length = std::hypot(n[0], n[1], n[2]);
      // At the poles the columns meet, and differences say nothing.
      const bool is_pole = length < 1e-14;
      const Point pole{0.0, row == 0 ? 1.0 : -1.0, 0.0};
      for (std::size_t k = 0; k < 3; ++k) frame.normals.push_back(static_cast<float>(is_pole ? pole[k] : n[k] / length));
    }
  }
  return frame;
}

double time_s(std::size_t frame) { return kBegin + static_cast<double>(frame) / kFramesPerSecond; }

model::Actor imported_character(const std::string& folder, const std::string& name) {
  auto root = assets::AssetRoot::open(folder);
  if (!root) give_up(root.error().message);
  std::vector<assets::AssetRoot> roots;
  roots.push_back(std::move(*root));
  const assets::AssetLibrary library(std::move(roots), Limits{});
  auto imported = library.import(name);
  if (!imported) give_up(imported.error().message);
  model::Actor actor;
  actor.name = name;
  actor.model = imported->model;
  for (model::Clip& clip : imported->clips) actor.clips.push_back(std::make_shared<const model::Clip>(std::move(clip)));
  return actor;
}

}  // namespace

MovingMesh moving_sphere() {
  constexpr std::size_t kRings = 313, kSides = 320;
  MovingMesh mesh{"sphere", {}};
  for (std::size_t i = 0; i < kMovingFrames; ++i) {
    const auto surface = [t = time_s(i)](double u, double v) -> Point {
      const double theta = u * std::numbers::pi, phi = v * 2.0 * std::numbers::pi;
      const double r = 1.0 + 0.2 * std::sin(3.0 * theta + 2.0 * t) * std::sin(2.0 * phi - t);
      return {r * std::sin(theta) * std::cos(phi), r * std::cos(theta), r * std::sin(theta) * std::sin(phi)};
    };
    mesh.frames.push_back(sampled(surface, kRings, kSides, (kSides - 1.0) / kSides));
  }
  return mesh;
}

MovingMesh moving_flag() {
  MovingMesh mesh{"flag", {}};
  for (std::size_t i = 0; i < kMovingFrames; ++i) {
    const auto surface = [t = time_s(i)](double u, double v) -> Point {
      const double wave = 0.12 * v * std::sin(9.0 * v - 7.0 * t + 1.5 * u) + 0.03 * v * std::sin(23.0 * v - 11.0 * t - 4.0 * u);
      return {1.5 * v - 0.05 * v * std::cos(7.0 * t), 1.0 - u - 0.1 * v * v, wave};
    };
    mesh.frames.push_back(sampled(surface, 150, 200, 1.0));
  }
  return mesh;
}

MovingMesh moving_character(const std::string& folder, const std::string& name) {
  const model::Actor actor = imported_character(folder, name);
  MovingMesh mesh{name, {}};
  model::Evaluator evaluator;
  for (std::size_t i = 0; i < kMovingFrames; ++i) {
    MovingMesh::Frame frame;
    frame.positions.resize(3 * actor.model->vertex_count());
    frame.normals.resize(frame.positions.size());
    const auto shown = model::shown_clip(actor.clips.front(), time_s(i) - kBegin + 0.2);
    if (!evaluator.vertices(actor, shown, {frame.positions, frame.normals, {}})) give_up("the character can't be evaluated");
    mesh.frames.push_back(std::move(frame));
  }
  return mesh;
}

MovingPose moving_pose(const std::string& folder, const std::string& name) {
  const model::Actor actor = imported_character(folder, name);
  const model::Skeleton& skeleton = *actor.model->skeleton;
  MovingPose moving{name, skeleton.size(), {}};
  model::Evaluator evaluator;
  for (std::size_t i = 0; i < kPoseFrames; ++i) {
    const double time = std::fmod(static_cast<double>(i) / kFramesPerSecond, actor.clips.front()->duration_s());
    const animation::Pose& pose = evaluator.pose(actor, model::shown_clip(actor.clips.front(), time));
    std::vector<float>& frame = moving.frames.emplace_back();
    for (std::uint32_t j = 0; j < skeleton.size(); ++j) {
      const animation::JointPose at = pose.joint(skeleton.place_of(j));
      for (const float x : {at.translation.x, at.translation.y, at.translation.z, at.rotation.x, at.rotation.y, at.rotation.z,
                            at.rotation.w, at.scale.x, at.scale.y, at.scale.z}) {
        frame.push_back(x);
      }
    }
  }
  return moving;
}

}  // namespace tweend::bench
