#include "server/model/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "server/model/evaluate.hpp"

namespace tweend::model {
namespace {

using animation::Interpolation;

struct Point {
  double x, y, z;
};

MeshPtr triangle() { return *Mesh::make(3, {0, 1, 2}); }
VertexKeyPtr key(const std::vector<float>& positions) { return *VertexKey::make(*triangle(), positions); }
VertexKeyPtr key_at(float x, float y, float z, float size = 0.01F) { return key({x, y, z, x + size, y, z, x, y + size, z}); }

ClipPtr clip_of(std::string name, std::vector<double> times_s, const std::vector<VertexKeyPtr>& keys,
                std::optional<Interpolation> mode = {}, std::optional<animation::CubicBezier> easing = {}) {
  Clip clip;
  clip.name = std::move(name);
  clip.settings.interpolation = mode;
  for (std::size_t i = 0; i < keys.size(); ++i) clip.keyframes.push_back({static_cast<KeyframeId>(i + 1), {}, easing, keys[i]});
  clip.times_s = std::move(times_s);
  return std::make_shared<const Clip>(std::move(clip));
}

Actor actor_of(VertexKeyPtr rest, std::vector<ClipPtr> clips, ActorSettings settings = {}) {
  auto model = std::make_shared<const Model>(Model{triangle(), std::move(rest), {}, {}, {}});
  return {"a", "mesh", std::move(model), std::move(settings), std::move(clips), {}};
}

Scene scene_of(const std::vector<Actor>& actors) {
  Scene scene;
  scene.name = "main";
  for (const Actor& a : actors) scene.actors.push_back(std::make_shared<const Actor>(a));
  return scene;
}

/// Scaled, spun about the own +Y, turned by a unit quaternion, moved: in double, without the code's matrices.
Point placed(const Transform& t, double spin, Point p) {
  p = {p.x * static_cast<double>(t.scale.x), p.y * static_cast<double>(t.scale.y), p.z * static_cast<double>(t.scale.z)};
  p = {p.x * std::cos(spin) + p.z * std::sin(spin), p.y, -p.x * std::sin(spin) + p.z * std::cos(spin)};
  const double qx = t.rotation.x, qy = t.rotation.y, qz = t.rotation.z, qw = t.rotation.w;
  const Point u{qy * p.z - qz * p.y + qw * p.x, qz * p.x - qx * p.z + qw * p.y, qx * p.y - qy * p.x + qw * p.z};
  return {p.x + 2 * (qy * u.z - qz * u.y) + static_cast<double>(t.translation.x),
          p.y + 2 * (qz * u.x - qx * u.z) + static_cast<double>(t.translation.y),
          p.z + 2 * (qx * u.y - qy * u.x) + static_cast<double>(t.translation.z)};
}

/// How far outside the box the farthest vertex gets, over all actors, clips, times and turns; at most 0 where all are inside.
double farthest_outside(const Scene& scene, const Bounds& box) {
  double worst = -1e300;
  for (const ActorPtr& a : scene.actors) {
    for (const ClipPtr& clip : a->clips) {
      for (int step = 0; step <= 200; ++step) {
        std::array<float, 9> positions{};
        EXPECT_TRUE(Evaluator().vertices(*a, shown_clip(clip, clip->duration_s() * step / 200.0), {positions, {}, {}}));
        for (int turn = 0; turn < (a->settings.spin_rad_s != 0.0 ? 32 : 1); ++turn) {
          for (std::size_t i = 0; i < 9; i += 3) {
            const Point p = placed(a->settings.transform, turn * std::numbers::pi / 16.0,
                                   {static_cast<double>(positions[i]), static_cast<double>(positions[i + 1]),
                                    static_cast<double>(positions[i + 2])});
            const double at[] = {p.x, p.y, p.z};
            for (int axis = 0; axis < 3; ++axis) {
              const auto low = static_cast<double>(box.min[axis]), high = static_cast<double>(box.max[axis]);
              const double rounding = 1e-5 * std::max({1.0, std::abs(low), std::abs(high)});
              worst = std::max({worst, low - at[axis] - rounding, at[axis] - high - rounding});
            }
          }
        }
      }
    }
  }
  return worst;
}

void expect_held(const Scene& scene) {
  const auto box = visible_bounds(scene);
  ASSERT_TRUE(box);
  EXPECT_LE(farthest_outside(scene, *box), 0.0);
}

TEST(Scene, FindsActorsByName) {
  Scene scene = scene_of({actor_of(key_at(0, 0, 0), {})});
  EXPECT_EQ(scene.find_actor("a"), scene.actors.front());
  EXPECT_EQ(scene.find_actor("A"), nullptr);
  EXPECT_EQ(scene.find_actor(""), nullptr);
}

TEST(VisibleBounds, IsNoLargerThanWhatItHolds) {
  const auto box = visible_bounds(scene_of({actor_of(key({-1, -2, -3, 1, 2, 3, 0, 0, 0}), {clip_of("c", {}, {})})}));
  EXPECT_EQ(box, (Bounds{{-1, -2, -3}, {1, 2, 3}}));
}

TEST(VisibleBounds, HoldsEveryKeyframeOfEveryClip) {
  expect_held(scene_of({actor_of(key_at(0, 0, 0), {clip_of("near", {0, 1}, {key_at(0, 0, 0), key_at(1, 0, 0)}),
                                                   clip_of("far", {0, 1}, {key_at(0, 50, 0), key_at(0, 0, -70)})})}));
}

TEST(VisibleBounds, HoldsTheRestShapeWhereAClipIsEmpty) {
  // The empty clip shows the rest shape, wherever the other clips' keyframes are.
  expect_held(scene_of({actor_of(key_at(100, 0, 0),
                                 {clip_of("default", {}, {}), clip_of("walk", {0, 1}, {key_at(0, 0, 0), key_at(1, 0, 0)})})}));
}

TEST(VisibleBounds, HoldsWhatCatmullRomOvershoots) {
  const std::vector<VertexKeyPtr> zigzag{key_at(0, 0, 0), key_at(1, 0, 0), key_at(1, 0, 0), key_at(0, 0, 0)};
  expect_held(scene_of({actor_of(zigzag[0], {clip_of("even", {0, 1, 2, 3}, zigzag, Interpolation::CatmullRom)})}));
  // A long way between two short ones swings out farthest.
  expect_held(scene_of({actor_of(zigzag[0], {clip_of("uneven", {0, 0.01, 5, 5.01}, zigzag, Interpolation::CatmullRom)})}));
  std::mt19937 random(9);
  std::uniform_real_distribution<float> place(-1.0F, 1.0F);
  std::exponential_distribution<double> gap(1.0);
  for (int round = 0; round < 20; ++round) {
    std::vector<VertexKeyPtr> keys;
    std::vector<double> times_s;
    for (int i = 0; i < 8; ++i) {
      keys.push_back(key_at(place(random), place(random), place(random)));
      times_s.push_back((times_s.empty() ? 0.0 : times_s.back() + 1e-3) + gap(random));
    }
    expect_held(scene_of({actor_of(keys[0], {clip_of("random", times_s, keys, Interpolation::CatmullRom)})}));
  }
}

TEST(VisibleBounds, HoldsWhatAnEasingOvershoots) {
  // y rises to about 2.4 on its way from 0 to 1: the actor goes far beyond its second keyframe and comes back.
  const std::vector<VertexKeyPtr> keys{key_at(0, 0, 0), key_at(10, 0, 0)};
  for (const auto mode : {Interpolation::Linear, Interpolation::CatmullRom}) {
    for (const auto easing : {animation::CubicBezier{0.3, 3.0, 0.7, 3.0}, animation::CubicBezier{0.3, -4.0, 0.7, 1.0}}) {
      expect_held(scene_of({actor_of(keys[0], {clip_of("bounce", {0, 1}, keys, mode, easing)})}));
    }
  }
}

TEST(VisibleBounds, HoldsWhatSpinsWhateverItsTransform) {
  std::mt19937 random(10);
  std::uniform_real_distribution<float> place(-5.0F, 5.0F), factor(0.1F, 8.0F);
  for (int round = 0; round < 50; ++round) {
    ActorSettings settings;
    settings.spin_rad_s = 1.0;
    settings.transform = {{place(random), place(random), place(random)},
                          glm::normalize(glm::quat(place(random), place(random), place(random), place(random))),
                          {factor(random), factor(random), factor(random)}};
    const VertexKeyPtr shape = key_at(place(random), place(random), place(random), 1.0F);
    expect_held(scene_of({actor_of(shape, {clip_of("c", {0}, {shape})}, settings)}));
  }
}

TEST(VisibleBounds, HoldsALongSpinningActorBesideAnother) {
  // A rod of 200 m along X by its scale: spinning, it points along Z as well.
  ActorSettings rod;
  rod.spin_rad_s = 1.0;
  rod.transform.scale = {100.0F, 1.0F, 1.0F};
  ActorSettings beside;
  beside.transform.translation = {0.0F, 0.0F, -60.0F};
  const VertexKeyPtr shape = key({-1, 0, 0, 1, 0, 0, 0, 0.01F, 0.01F});
  const VertexKeyPtr small = key_at(0, 0, 0);
  expect_held(
      scene_of({actor_of(shape, {clip_of("c", {0}, {shape})}, rod), actor_of(small, {clip_of("c", {0}, {small})}, beside)}));
}

TEST(VisibleBounds, LeavesOutWhatIsInvisibleBesideWhatIsNot) {
  ActorSettings hidden;
  hidden.visible = false;
  hidden.transform.translation = {1000.0F, 0.0F, 0.0F};
  const VertexKeyPtr shape = key_at(0, 0, 0, 1.0F);
  const auto alone = visible_bounds(scene_of({actor_of(shape, {clip_of("c", {0}, {shape})})}));
  const auto both = visible_bounds(
      scene_of({actor_of(shape, {clip_of("c", {0}, {shape})}, hidden), actor_of(shape, {clip_of("c", {0}, {shape})})}));
  ASSERT_TRUE(alone && both);
  EXPECT_EQ(*alone, *both);
}

TEST(Fit, ShowsAllEightCornersOfABoxFromAnySide) {
  std::mt19937 random(12);
  std::uniform_real_distribution<float> place(-20.0F, 20.0F), extent(0.01F, 30.0F), angle(0.1F, 2.5F);
  for (int round = 0; round < 200; ++round) {
    const glm::vec3 low(place(random), place(random), place(random));
    const glm::vec3 high = low + glm::vec3(extent(random), extent(random), extent(random));
    const VertexKeyPtr box = key({low.x, low.y, low.z, high.x, high.y, high.z, low.x, high.y, low.z});
    Camera camera;
    camera.eye = {place(random), place(random), place(random)};
    camera.target = {place(random), place(random), place(random)};
    camera.fov_y = angle(random);
    const auto bounds = visible_bounds(scene_of({actor_of(box, {clip_of("c", {0}, {box})})}));
    ASSERT_TRUE(bounds);
    const Camera fitted = fit(camera, *bounds);

    const auto unit = [](Point p) {
      const double length = std::hypot(p.x, p.y, p.z);
      return Point{p.x / length, p.y / length, p.z / length};
    };
    const auto between = [](const glm::vec3& from, const glm::vec3& to) {
      return Point{static_cast<double>(to.x) - static_cast<double>(from.x),
                   static_cast<double>(to.y) - static_cast<double>(from.y),
                   static_cast<double>(to.z) - static_cast<double>(from.z)};
    };
    const auto dot = [](Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
    const Point forward = unit(between(fitted.eye, fitted.target));
    const Point right = unit({-forward.z, 0.0, forward.x});  // forward × +Y
    const Point up{right.y * forward.z - right.z * forward.y, right.z * forward.x - right.x * forward.z,
                   right.x * forward.y - right.y * forward.x};
    const double half_height = std::tan(static_cast<double>(fitted.fov_y) / 2.0);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 at((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                         (corner & 4) != 0 ? high.z : low.z);
      const Point d = between(fitted.eye, at);
      const double depth = dot(d, forward);
      EXPECT_GT(depth, static_cast<double>(fitted.near));
      EXPECT_LT(depth, static_cast<double>(fitted.far));
      for (const double aspect : {1.0, 16.0 / 9.0}) {
        EXPECT_LE(std::abs(dot(d, right)), depth * half_height * aspect) << "corner " << corner;
        EXPECT_LE(std::abs(dot(d, up)), depth * half_height) << "corner " << corner;
      }
    }
    EXPECT_NEAR(dot(forward, unit(between(camera.eye, camera.target))), 1.0, 1e-5) << "the direction stays";
    EXPECT_EQ(fitted.fov_y, camera.fov_y);
    EXPECT_EQ(fitted.up, camera.up);
  }
}

}  // namespace
}  // namespace tweend::model
