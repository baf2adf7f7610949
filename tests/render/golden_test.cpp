#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <vector>

#include "server/animation/key_blend.hpp"
#include "server/animation/vertex_normals.hpp"
#include "tests/render/support/compare.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/shape.hpp"

// Whole pictures against ones that were looked at once, in tests/render/golden.

namespace tweend::render {
namespace {

using animation::Interpolation;
using animation::KeyBlend;
using test::Image;
using test::Shape;

constexpr Size kSize{320, 180};
const std::array<double, 4> kTimes{0.0, 0.4, 1.0, 1.3};

/// A column of rings that bends, twists and bulges more with each keyframe.
Shape swaying_column() {
  Shape shape = test::ball(40, 64);
  const std::vector<float> round = shape.blocks[0];
  shape.blocks.clear();
  for (const float sway : {-1.0F, 0.6F, 1.0F, -0.4F}) {
    std::vector<float> block(9 * shape.vertex_count, 0.0F);
    for (std::size_t v = 0; v < shape.vertex_count; ++v) {
      const float* from = round.data() + 3 * v;
      const float up = 0.5F + 0.5F * from[1];
      const float angle = 2.5F * sway * up;
      const float wide = 0.8F + 0.35F * std::cos(3.0F * std::atan2(from[0], from[2]));
      const float x = wide * from[0], z = wide * from[2];
      block[3 * v] = std::cos(angle) * x + std::sin(angle) * z + 0.9F * sway * up * up;
      block[3 * v + 1] = 2.2F * up;
      block[3 * v + 2] = std::cos(angle) * z - std::sin(angle) * x;
      block[6 * shape.vertex_count + 3 * v] = 1.0F;
    }
    const std::span<float> all(block);
    const std::size_t stream = 3 * shape.vertex_count;
    EXPECT_TRUE(animation::compute_normals(all.first(stream), shape.indices, all.subspan(stream, stream)));
    shape.blocks.push_back(std::move(block));
  }
  shape.materials[0].base_color = {0.85F, 0.45F, 0.25F};
  return shape;
}

Picture studio() {
  Picture picture;
  picture.size = kSize;
  picture.view.eye = {1.5F, 2.2F, 4.2F};
  const glm::vec3 target(0.2F, 1.0F, 0.0F);
  picture.view.view_from_world = glm::lookAt(picture.view.eye, target, glm::vec3(0.0F, 1.0F, 0.0F));
  picture.view.clip_from_view = glm::perspective(glm::radians(45.0F), 16.0F / 9.0F, 0.05F, 100.0F);
  picture.view.focus_m = glm::length(picture.view.eye - target);
  picture.light = {{2.5F, 4.0F, 3.0F}, 0.2F, 0.8F, 0.5F, 40.0F};
  picture.background = {0.12F, 0.13F, 0.15F};
  return picture;
}

class Golden : public testing::Test {
 protected:
  /// The column at a time, blended as the server blends.
  [[nodiscard]] Picture column(Interpolation mode, double time_s) const {
    const animation::KeyTimeline timeline{kTimes, 1.7, true};
    const KeyBlend blend = blend_keys(timeline, locate(timeline, time_s), mode, nullptr);
    DrawItem item;
    item.mesh = column_.source();
    item.key_count = blend.count;
    item.keys_expected = kTimes.size();
    for (std::size_t i = 0; i < blend.count; ++i) item.key[i] = column_.key(blend.key[i]);
    item.weight = blend.weight;
    item.nearest = blend.nearest;
    Picture picture = studio();
    picture.items = {item};
    return picture;
  }
  /// A textured ball whose lower half is plain, a mirrored one, and the ground.
  [[nodiscard]] Picture still_life() const {
    Picture picture = studio();
    picture.grid = true;
    DrawItem left = ball_.item();
    left.world_from_model = glm::translate(glm::mat4(1.0F), glm::vec3(-0.9F, 0.9F, 0.0F));
    DrawItem right = ball_.item();
    right.world_from_model = glm::translate(glm::mat4(1.0F), glm::vec3(1.3F, 0.7F, 0.3F)) *
                             glm::scale(glm::mat4(1.0F), glm::vec3(-0.7F, 1.2F, 0.7F));
    picture.items = {left, right};
    return picture;
  }
  Golden() {
    for (std::uint32_t y = 0; y < kTexture.height; ++y) {
      for (std::uint32_t x = 0; x < kTexture.width; ++x) {
        const bool light = (x / 4 + y / 4) % 2 == 0;
        const auto fade = static_cast<std::uint8_t>(255 * x / kTexture.width);
        for (const std::uint8_t c : {light ? fade : std::uint8_t{20}, light ? std::uint8_t{200} : fade, std::uint8_t{90}}) {
          texels_.push_back(c);
        }
        texels_.push_back(255);
      }
    }
    const auto half = static_cast<std::uint32_t>(ball_.indices.size() / 2);
    ball_.materials = {{{0.3F, 0.5F, 0.9F}, {}}, {glm::vec3(1.0F), TextureSource{{8, 8}, kTexture, texels_}}};
    ball_.parts = {{0, half, 0}, {half, half, 1}};
  }

  static constexpr Size kTexture{64, 32};
  const Shape column_ = swaying_column();
  Shape ball_ = test::ball();
  std::vector<std::uint8_t> texels_;
  test::Offscreen gpu_;
};

TEST_F(Golden, AShapeLerpedBetweenTwoKeyframes) {
  test::expect_golden("column_linear", gpu_.draw(column(Interpolation::Linear, 0.6)));
}

TEST_F(Golden, AShapeOnACatmullRomSplineThroughFour) {
  test::expect_golden("column_catmull_rom", gpu_.draw(column(Interpolation::CatmullRom, 0.6)));
}

TEST_F(Golden, TexturedAndMirroredOnTheGround) { test::expect_golden("still_life", gpu_.draw(still_life())); }

TEST_F(Golden, TheSameWithFourSamplesAPixel) { test::expect_golden("still_life_4_samples", gpu_.draw(still_life(), 4)); }

// The comparison itself: it lets rounding pass, and nothing else.

TEST_F(Golden, RoundingIsAlike) {
  const Image image = gpu_.draw(still_life());
  EXPECT_TRUE(test::alike(test::difference(image, image)));
  Image rounded = image;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) rounded.rgb[i] ^= 1;
  EXPECT_TRUE(test::alike(test::difference(image, rounded)));
}

TEST_F(Golden, EachWrongTermIsNotAlike) {
  const Picture right = column(Interpolation::CatmullRom, 0.6);
  const Image image = gpu_.draw(right);
  const auto expect_seen = [&](const char* what, auto change) {
    Picture wrong = right;
    change(wrong);
    const test::Difference d = test::difference(image, gpu_.draw(wrong));
    EXPECT_FALSE(test::alike(d)) << what << ": mean " << d.mean << ", most " << d.most;
  };
  expect_seen("a light that stands elsewhere", [](Picture& p) { p.light.position.x -= 0.4F; });
  expect_seen("less diffuse light", [](Picture& p) { p.light.diffuse *= 0.9F; });
  expect_seen("more ambient light", [](Picture& p) { p.light.ambient *= 1.2F; });
  expect_seen("no highlight", [](Picture& p) { p.light.specular = 0.0F; });
  expect_seen("a broader highlight", [](Picture& p) { p.light.shininess *= 0.5F; });
  expect_seen("a moment later", [&](Picture& p) { p.items = column(Interpolation::CatmullRom, 0.62).items; });
  expect_seen("straight instead of a spline", [&](Picture& p) { p.items = column(Interpolation::Linear, 0.6).items; });
  expect_seen("a grid", [](Picture& p) { p.grid = true; });
  expect_seen("a background", [](Picture& p) { p.background += 0.02F; });
}

TEST_F(Golden, AMissingFileOrAnotherSizeIsNotAlike) {
  const Image image = gpu_.draw(still_life());
  EXPECT_FALSE(test::alike(test::difference(test::decode_png(test::read_file("/nonexistent.png")), image)));
  EXPECT_FALSE(test::alike(test::difference(Image(Size{320, 181}), image)));
}

TEST(SideBySide, ShowsBothAndWhereTheyDiffer) {
  Image a(Size{2, 1}), b(Size{2, 1});
  a.set(0, 0, {10, 20, 30});
  b.set(0, 0, {12, 20, 25});
  const Image all = test::side_by_side(a, b);
  ASSERT_EQ(all.size, (Size{6, 1}));
  EXPECT_EQ(all.at(0, 0), (test::Rgb{10, 20, 30}));
  EXPECT_EQ(all.at(2, 0), (test::Rgb{12, 20, 25}));
  EXPECT_EQ(all.at(4, 0), (test::Rgb{144, 128, 88}));
  EXPECT_EQ(all.at(5, 0), (test::Rgb{128, 128, 128}));
}

}  // namespace
}  // namespace tweend::render
