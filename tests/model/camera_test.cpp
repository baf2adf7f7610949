#include "server/model/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

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

TEST(Camera, FitBringsTheWholeBallIntoViewAndKeepsTheDirection) {
  for (const float radius : {0.01F, 1.0F, 5000.0F}) {
    Camera c;
    c.eye = {3, 4, 5};
    c.target = {0, 1, 0};
    const Sphere ball{{10, -3, 2}, radius};
    const Camera fitted = fit(c, ball);
    const Vec before = unit(minus(of(c.target), of(c.eye))), after = unit(minus(of(fitted.target), of(fitted.eye)));
    EXPECT_NEAR(dot(before, after), 1.0, 1e-6);
    for (int a = 0; a < 24; ++a) {
      for (int e = -6; e <= 6; ++e) {
        const double az = a * 0.2618, el = e * 0.2618;
        const Vec point{ball.center.x + radius * std::cos(el) * std::sin(az), ball.center.y + radius * std::sin(el),
                        ball.center.z + radius * std::cos(el) * std::cos(az)};
        EXPECT_TRUE(sees(fitted, point, 1.0)) << radius << " " << a << " " << e;
        EXPECT_TRUE(sees(fitted, point, 16.0 / 9.0));
      }
    }
  }
}

TEST(Camera, FitOfAPointIsStillACamera) {
  const Camera fitted = fit(Camera{}, Sphere{{1, 1, 1}, 0});
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
  return std::make_shared<const Actor>(Actor{"a", "mesh", mesh, key, settings, {std::make_shared<const Clip>(clip)}});
}

bool holds(const Sphere& ball, Vec p) {
  const Vec d = minus(p, of(ball.center));
  return std::sqrt(dot(d, d)) <= ball.radius * 1.00001;
}

TEST(BoundingSphere, IgnoresWhatIsInvisible) {
  Scene scene;
  EXPECT_FALSE(bounding_sphere(scene));
  ActorSettings hidden;
  hidden.visible = false;
  scene.actors = {actor({0, 0, 0, 100, 0, 0, 0, 100, 0}, hidden)};
  EXPECT_FALSE(bounding_sphere(scene));
}

TEST(BoundingSphere, HoldsTransformedActorsAndWhatTheySweepWhileSpinning) {
  ActorSettings placed;
  placed.transform.translation = {0, 50, 0};
  ActorSettings spinning;
  spinning.spin_rad_s = 1;
  Scene scene;
  scene.actors = {actor({0, 0, 0, 1, 0, 0, 0, 1, 0}, placed), actor({7, 0, 0, 8, 0, 0, 7, 1, 0}, spinning)};
  const auto ball = bounding_sphere(scene);
  ASSERT_TRUE(ball);
  EXPECT_TRUE(holds(*ball, {1, 50, 0}));
  EXPECT_TRUE(holds(*ball, {0, 51, 0}));
  for (int i = 0; i < 16; ++i) EXPECT_TRUE(holds(*ball, {8 * std::sin(i * 0.3927), 0, 8 * std::cos(i * 0.3927)})) << i;
}

}  // namespace
}  // namespace tweend::model
