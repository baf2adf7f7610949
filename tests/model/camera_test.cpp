#include "server/model/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "server/model/scene.hpp"

namespace tweend::model {
namespace {

struct Vec {
  double x, y, z;
};
Vec minus(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Vec unit(Vec a) {
  const double l = std::sqrt(dot(a, a));
  return {a.x / l, a.y / l, a.z / l};
}
Vec of(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// Whether the camera sees the point at this aspect ratio, by plain trigonometry.
bool sees(const Camera& c, Vec point, double aspect) {
  const Vec forward = unit(minus(of(c.target), of(c.eye)));
  const Vec right = unit(cross(forward, of(c.up)));
  const Vec up = cross(right, forward);
  const Vec d = minus(point, of(c.eye));
  const double depth = dot(d, forward), half = std::tan(c.fov_y / 2.0);
  return depth > c.near && depth < c.far && std::abs(dot(d, up)) <= depth * half * 1.000001 &&
         std::abs(dot(d, right)) <= depth * half * aspect * 1.000001;
}

TEST(Camera, OrbitPlacesTheEyeByItsAngles) {
  Camera c;
  c.target = {1, 2, 3};
  const Camera front = orbit(c, 0, 0, 5);
  EXPECT_NEAR(front.eye.z, 8, 1e-5);
  const Camera side = orbit(c, 1.5707963F, 0, 5);
  EXPECT_NEAR(side.eye.x, 6, 1e-5);
  const Camera above = orbit(c, 0, 0.5235988F, 2);  // 30 degrees: sin is a half
  EXPECT_NEAR(above.eye.y, 3, 1e-5);
}

TEST(Camera, FitBringsTheWholeBoxIntoViewAndKeepsTheDirection) {
  for (const float radius : {0.01F, 1.0F, 5000.0F}) {
    Camera c;
    c.eye = {3, 4, 5};
    c.target = {0, 1, 0};
    const glm::vec3 center{10, -3, 2};
    const Camera fitted = fit(c, Bounds{center - radius, center + radius});
    const Vec before = unit(minus(of(c.target), of(c.eye))), after = unit(minus(of(fitted.target), of(fitted.eye)));
    EXPECT_NEAR(dot(before, after), 1.0, 1e-6);
    for (int a = 0; a < 24; ++a) {
      for (int e = -6; e <= 6; ++e) {
        const double az = a * 0.2618, el = e * 0.2618;
        const Vec point{center.x + radius * std::cos(el) * std::sin(az), center.y + radius * std::sin(el),
                        center.z + radius * std::cos(el) * std::cos(az)};
        EXPECT_TRUE(sees(fitted, point, 1.0)) << radius << " " << a << " " << e;
        EXPECT_TRUE(sees(fitted, point, 16.0 / 9.0));
      }
    }
  }
}

// A row of actors fills a wide picture, and a tall one shows all of it too.
TEST(Camera, FitFollowsThePicturesShape) {
  const Bounds row{{-10, 0, -1}, {10, 2, 1}};
  const Camera wide = fit(Camera{}, row, 4.0F), square = fit(Camera{}, row), tall = fit(Camera{}, row, 0.25F);
  const auto distance = [](const Camera& c) {
    return std::sqrt(dot(minus(of(c.eye), of(c.target)), minus(of(c.eye), of(c.target))));
  };
  EXPECT_LT(distance(wide), 0.5 * distance(square));
  EXPECT_GT(distance(tall), 2.0 * distance(square));
  for (const auto& [camera, aspect] : {std::pair{wide, 4.0}, std::pair{square, 1.0}, std::pair{tall, 0.25}}) {
    for (const double x : {-10.0, 10.0}) EXPECT_TRUE(sees(camera, {x, 2.0, 1.0}, aspect)) << aspect;
  }
}

TEST(Camera, FitOfAPointIsStillACamera) {
  const Camera fitted = fit(Camera{}, Bounds{{1, 1, 1}, {1, 1, 1}});
  EXPECT_GT(fitted.near, 0);
  EXPECT_GT(fitted.far, fitted.near);
  EXPECT_NE(fitted.eye, fitted.target);
}

ActorPtr actor(std::vector<float> positions, ActorSettings settings = {}) {
  const MeshPtr mesh = *Mesh::make(3, {0, 1, 2});
  const VertexKeyPtr key = *VertexKey::make(*mesh, positions);
  Clip clip;
  clip.times_s = {0};
  clip.keyframes = {{1, {}, {}, key}};
  const auto model = std::make_shared<const Model>(Model{mesh, key, {}, {}, {}});
  return std::make_shared<const Actor>(Actor{"a", "mesh", model, settings, {std::make_shared<const Clip>(clip)}, {}});
}

bool holds(const Bounds& box, Vec p) {
  constexpr double kRounding = 1e-4;
  const Vec min = of(box.min), max = of(box.max);
  return p.x >= min.x - kRounding && p.x <= max.x + kRounding && p.y >= min.y - kRounding && p.y <= max.y + kRounding &&
         p.z >= min.z - kRounding && p.z <= max.z + kRounding;
}

TEST(VisibleBounds, IgnoresWhatIsInvisible) {
  Scene scene;
  EXPECT_FALSE(visible_bounds(scene));
  ActorSettings hidden;
  hidden.visible = false;
  scene.actors = {actor({0, 0, 0, 100, 0, 0, 0, 100, 0}, hidden)};
  EXPECT_FALSE(visible_bounds(scene));
}

TEST(VisibleBounds, HoldsTransformedActorsAndWhatTheySweepWhileSpinning) {
  ActorSettings placed;
  placed.transform.translation = {0, 50, 0};
  ActorSettings spinning;
  spinning.spin_rad_s = 1;
  Scene scene;
  scene.actors = {actor({0, 0, 0, 1, 0, 0, 0, 1, 0}, placed), actor({7, 0, 0, 8, 0, 0, 7, 1, 0}, spinning)};
  const auto box = visible_bounds(scene);
  ASSERT_TRUE(box);
  EXPECT_TRUE(holds(*box, {1, 50, 0}));
  EXPECT_TRUE(holds(*box, {0, 51, 0}));
  for (int i = 0; i < 16; ++i) EXPECT_TRUE(holds(*box, {8 * std::sin(i * 0.3927), 0, 8 * std::cos(i * 0.3927)})) << i;
}

}  // namespace
}  // namespace tweend::model
