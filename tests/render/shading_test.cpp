#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <vector>

#include "render/gpu_mesh.hpp"
#include "tests/render/support/light.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/shape.hpp"

// One term of the light at a time, each pixel against the same worked out in double (tests/render/support/light.hpp).

namespace tweend::render {
namespace {

using test::Image;
using test::Rgb;
using test::Shape;
using test::Vec3d;

constexpr Size kSize{48, 48};
constexpr double kDistance = 4.0;  // of the eye from the plane z = 0, on +Z
constexpr double kHalfView = 1.0;  // half of what the view shows of that plane
const Rgb kBlack{0, 0, 0};

Picture looking_at_origin(Size size = kSize) {
  Picture picture;
  picture.size = size;
  picture.view.eye = {0.0F, 0.0F, static_cast<float>(kDistance)};
  picture.view.view_from_world = glm::lookAt(picture.view.eye, glm::vec3(0.0F), glm::vec3(0.0F, 1.0F, 0.0F));
  picture.view.clip_from_view =
      glm::perspective(static_cast<float>(2.0 * std::atan(kHalfView / kDistance)),
                       static_cast<float>(size.width) / static_cast<float>(size.height), 0.1F, 100.0F);
  picture.view.focus_m = static_cast<float>(kDistance);
  return picture;
}

/// The point of the plane z = 0 that a pixel's centre shows, in square pictures.
Vec3d on_plane(std::size_t x, std::size_t y) {
  const double right = (static_cast<double>(x) + 0.5) / kSize.width * 2.0 - 1.0;
  const double down = (static_cast<double>(y) + 0.5) / kSize.height * 2.0 - 1.0;
  return {right * kHalfView, -down * kHalfView, 0.0};
}

void expect_color(const Rgb& found, const std::array<double, 3>& expected, const std::string& where, double tolerance = 1.0) {
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << where << ", channel " << c;
}

class Shading : public testing::Test {
 protected:
  Image draw(const Picture& picture, int samples = 1) { return gpu_.draw(picture, samples); }
  /// Draws a square over the whole view and compares every pixel.
  void expect_lit_square(const PointLight& light, Vec3d normal = {0, 0, 1}, glm::vec3 srgb = glm::vec3(1.0F)) {
    Shape shape = test::square(2.0F, 0.0F, glm::vec3(normal));
    shape.materials[0].base_color = srgb;
    Picture picture = looking_at_origin();
    picture.light = light;
    picture.items = {shape.item()};
    const Image image = draw(picture);
    for (std::size_t y = 0; y < kSize.height; ++y) {
      for (std::size_t x = 0; x < kSize.width; ++x) {
        const Vec3d seen = test::lit(light, on_plane(x, y), normal, {0, 0, kDistance}, test::decode_srgb(Vec3d(srgb)));
        expect_color(image.at(x, y), test::srgb_bytes(seen), "pixel " + std::to_string(x) + ", " + std::to_string(y));
        if (HasFailure()) return;
      }
    }
  }
  /// What the middle of a picture of this item shows.
  Rgb middle(const DrawItem& item, const PointLight& light) {
    Picture picture = looking_at_origin();
    picture.light = light;
    picture.items = {item};
    return draw(picture).at(kSize.width / 2, kSize.height / 2);
  }
  test::Offscreen gpu_;
};

TEST_F(Shading, SrgbIsDecodedByItsStandard) {
  for (int i = -20; i <= 280; ++i) {
    const double c = std::clamp(i / 255.0, 0.0, 1.0);
    const glm::vec3 linear = linear_from_srgb(glm::vec3(static_cast<float>(i) / 255.0F, 0.0F, 1.0F));
    EXPECT_NEAR(linear.x, test::decode_srgb(c), 1e-6);
    EXPECT_EQ(linear.y, 0.0F);
    EXPECT_NEAR(linear.z, 1.0F, 1e-6);
  }
}

TEST_F(Shading, ABackgroundIsExactlyItsColour) {
  for (const int value : {0, 1, 10, 11, 40, 128, 254, 255}) {
    Picture picture = looking_at_origin();
    picture.background = glm::vec3(static_cast<float>(value), static_cast<float>(255 - value), 77.0F) / 255.0F;
    const Image image = draw(picture);
    for (const auto& [x, y] : {std::pair{0, 0}, {47, 0}, {20, 30}, {47, 47}}) {
      expect_color(image.at(static_cast<std::size_t>(x), static_cast<std::size_t>(y)), {double(value), 255.0 - value, 77.0},
                   "background");
    }
  }
}

TEST_F(Shading, AmbientLightIsStrongerFromAbove) {
  PointLight light;
  light.position = {0, 0, 5};
  light.ambient = 0.5F;
  for (const Vec3d normal : {Vec3d(0, 0, 1), Vec3d(0, 1, 0), Vec3d(0, -1, 0), Vec3d(0.6, 0.8, 0), Vec3d(0, -0.6, 0.8)}) {
    expect_lit_square(light, normal);
  }
}

TEST_F(Shading, DiffuseLightFollowsLambertsCosine) {
  PointLight light;
  light.diffuse = 0.9F;
  for (const glm::vec3 position :
       {glm::vec3(0, 0, 5), glm::vec3(3, 0, 3), glm::vec3(0, -5, 1), glm::vec3(-0.3, 0.4, 0.2), glm::vec3(0, 0, -5)}) {
    light.position = position;
    expect_lit_square(light);
  }
  light.position = {0, 0, 1000};  // from so far that the angle is the same everywhere
  for (const double degrees : {0.0, 30.0, 60.0, 85.0}) {
    const double angle = degrees * 3.14159265358979 / 180.0;
    expect_lit_square(light, {std::sin(angle), 0.0, std::cos(angle)});
  }
}

TEST_F(Shading, HighlightsFollowBlinnsHalfVector) {
  PointLight light;
  light.specular = 0.8F;
  for (const float shininess : {1.0F, 8.0F, 128.0F}) {
    light.shininess = shininess;
    for (const glm::vec3 position : {glm::vec3(0, 0, 4), glm::vec3(2, 1, 3), glm::vec3(-1, 0, 0.5), glm::vec3(0, 0, -3)}) {
      light.position = position;
      expect_lit_square(light, {0, 0, 1}, {0.9F, 0.1F, 0.1F});
    }
  }
}

TEST_F(Shading, ABaseColourIsLitInLinearLight) {
  PointLight light;
  light.position = {1, 2, 4};
  light.ambient = 0.2F;
  light.diffuse = 0.6F;
  light.specular = 0.3F;
  light.shininess = 20.0F;
  for (const glm::vec3 color : {glm::vec3(0.5, 0.25, 0.75), glm::vec3(0, 1, 0.02), glm::vec3(1, 1, 1)}) {
    expect_lit_square(light, {0, 0, 1}, color);
  }
}

TEST_F(Shading, ABackFaceIsLitAsTheFrontIs) {
  PointLight light;
  light.position = {0, 0, 5};
  light.ambient = 0.1F;
  light.diffuse = 0.5F;
  const Shape shape = test::square(2.0F);
  DrawItem turned = shape.item();
  turned.world_from_model = glm::rotate(glm::mat4(1.0F), glm::radians(180.0F), glm::vec3(0, 1, 0));
  const auto expected = test::srgb_bytes(test::lit(light, {0, 0, 0}, {0, 0, 1}, {0, 0, kDistance}, Vec3d(1)));
  expect_color(middle(shape.item(), light), expected, "front");
  expect_color(middle(turned, light), expected, "back");
}

TEST_F(Shading, AMirroredActorKeepsItsFronts) {
  PointLight light;  // from the side: a normal turned the wrong way would be dark
  light.position = {5, 0, 2};
  light.diffuse = 1.0F;
  const Vec3d normal = glm::normalize(Vec3d(0.6, 0.0, 0.8));
  const Shape shape = test::square(2.0F, 0.0F, glm::vec3(normal));
  DrawItem item = shape.item();
  for (const glm::vec3 scale : {glm::vec3(1, -1, 1), glm::vec3(-1, 1, 1), glm::vec3(-1, -1, 1)}) {
    item.world_from_model = glm::scale(glm::mat4(1.0F), scale);
    const Vec3d turned = glm::normalize(normal / Vec3d(scale));
    expect_color(middle(item, light), test::srgb_bytes(test::lit(light, {0, 0, 0}, turned, {0, 0, kDistance}, Vec3d(1))),
                 "scaled by " + std::to_string(scale.x) + ", " + std::to_string(scale.y));
  }
}

TEST_F(Shading, NormalsStandUprightOnStretchedActors) {
  PointLight light;
  light.position = {0, 50, 50};
  light.diffuse = 0.8F;
  const Vec3d normal = glm::normalize(Vec3d(0.0, 1.0, 1.0));
  const Shape shape = test::square(2.0F, 0.0F, glm::vec3(normal));
  DrawItem item = shape.item();
  for (const glm::vec3 scale : {glm::vec3(1, 3, 1), glm::vec3(1, 1, 4), glm::vec3(2, 0.5, 0.25)}) {
    item.world_from_model = glm::scale(glm::mat4(1.0F), scale);
    // A plane's normal is divided by what its points are multiplied with.
    const Vec3d stretched = glm::normalize(normal / Vec3d(scale));
    expect_color(middle(item, light), test::srgb_bytes(test::lit(light, {0, 0, 0}, stretched, {0, 0, kDistance}, Vec3d(1))),
                 "scaled by " + std::to_string(scale.y) + ", " + std::to_string(scale.z));
  }
}

TEST_F(Shading, TheNearerOneIsSeenInWhateverOrderTheyAreDrawn) {
  PointLight light;
  light.position = {0, 0, 5};
  light.ambient = 1.0F;
  Shape near = test::square(0.5F, 0.5F);
  Shape far = test::square(2.0F, -0.5F);
  near.materials[0].base_color = {1, 0, 0};
  far.materials[0].base_color = {0, 0, 1};
  Picture picture = looking_at_origin();
  picture.light = light;
  for (const bool near_first : {true, false}) {
    picture.items = near_first ? std::vector{near.item(), far.item()} : std::vector{far.item(), near.item()};
    const Image image = draw(picture);
    EXPECT_EQ(image.at(24, 24), (Rgb{255, 0, 0}));
    EXPECT_EQ(image.at(2, 2), (Rgb{0, 0, 255}));
  }
}

TEST_F(Shading, SeveralSamplesSoftenEdgesAndNothingElse) {
  Picture picture = looking_at_origin();
  picture.background = glm::vec3(0.2F, 0.4F, 0.6F);
  const Image flat = draw(picture, 4);
  const Rgb background{51, 102, 153};
  for (std::size_t i = 0; i < flat.rgb.size(); ++i) EXPECT_NEAR(flat.rgb[i], background[i % 3], 1);

  picture.background = {};
  picture.light.ambient = 1.0F;
  const Shape shape = test::square(0.6F);
  DrawItem item = shape.item();
  item.world_from_model = glm::rotate(glm::mat4(1.0F), 0.3F, glm::vec3(0, 0, 1));
  picture.items = {item};
  const auto count_between = [](const Image& image) {
    int between = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) between += image.rgb[i] > 20 && image.rgb[i] < 235 ? 1 : 0;
    return between;
  };
  EXPECT_EQ(count_between(draw(picture, 1)), 0);
  const Image soft = draw(picture, 4);
  EXPECT_GT(count_between(soft), 40);
  EXPECT_EQ(soft.at(24, 24), (Rgb{255, 255, 255}));
  EXPECT_EQ(soft.at(0, 0), kBlack);
  // Samples are averaged in linear light: of two in four, 188 is seen, not 128.
  const auto is_half = [](std::uint8_t value) { return std::abs(int{value} - 188) <= 1; };
  EXPECT_TRUE(std::any_of(soft.rgb.begin(), soft.rgb.end(), is_half));
}

TEST_F(Shading, OnePictureLeavesNothingBehindForTheNext) {
  Picture plain = looking_at_origin();
  plain.light.ambient = 0.6F;
  plain.light.position = {0, 0, 5};
  const Shape shape = test::square(0.5F);
  plain.items = {shape.item()};
  const Image before = draw(plain);
  Picture busy = looking_at_origin({64, 20});
  busy.grid = true;
  busy.background = glm::vec3(0.5F);
  const Shape ball = test::ball();
  DrawItem mirrored = ball.item();
  mirrored.world_from_model = glm::scale(glm::mat4(1.0F), glm::vec3(-1, 1, 1));
  busy.items = {mirrored};
  static_cast<void>(draw(busy, 4));
  EXPECT_EQ(draw(plain), before);
}

TEST_F(Shading, TrianglesThatAJointMirrorsAreLitFromTheirOutside) {
  Shape shape = test::square(2.0F);
  shape.influences = 1;
  shape.entries.assign(4, 0);
  Picture picture = looking_at_origin();
  picture.light = {{1.0F, 1.0F, 3.0F}, 0.1F, 0.9F, 0.0F, 1.0F};
  picture.items = {shape.item()};
  const Image expected = draw(picture);
  ASSERT_GT(expected.at(24, 24)[0], 150);
  // Row by row: across x, and where it is.
  const std::array<float, 12> mirrored{-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  for (const float actor : {1.0F, -1.0F}) {
    picture.items[0].palette = mirrored;
    picture.items[0].world_from_model[0][0] = actor;
    const Image found = draw(picture);
    for (std::size_t i = 0; i < found.rgb.size(); ++i) EXPECT_NEAR(found.rgb[i], expected.rgb[i], 1) << "actor " << actor;
  }
}

}  // namespace
}  // namespace tweend::render
