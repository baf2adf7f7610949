#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <vector>

#include "tests/render/support/flat.hpp"
#include "tests/render/support/light.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/shape.hpp"

// Textures, materials and the ground: what lies on surfaces. Light comes from everywhere, so that colours are plain to see.

namespace tweend::render {
namespace {

using test::Image;
using test::Rgb;
using test::Shape;
using test::Vec3d;

constexpr std::uint32_t kTexels = 4;   // a side
constexpr std::uint32_t kTexelPx = 9;  // pixels a texel: odd, so that one pixel's centre is the texel's
constexpr Size kSize{kTexels * kTexelPx, kTexels* kTexelPx};

Picture flat_picture() { return test::flat_picture(kSize); }

std::vector<std::uint8_t> numbered_texels() {
  std::vector<std::uint8_t> rgba;
  for (std::uint32_t i = 0; i < kTexels * kTexels; ++i) {
    const auto value = static_cast<std::uint8_t>(16 * i);
    rgba.insert(rgba.end(),
                {value, static_cast<std::uint8_t>(255 - value), static_cast<std::uint8_t>(i % 2 == 0 ? 30 : 220), 0});
  }
  return rgba;
}

class Surface : public testing::Test {
 protected:
  Image draw(const Picture& picture) { return gpu_.draw(picture); }
  Image draw(const Shape& shape) {
    Picture picture = flat_picture();
    picture.items = {shape.item()};
    return gpu_.draw(picture);
  }
  [[nodiscard]] Shape textured() const {
    Shape shape = test::square(1.0F);
    shape.materials = {{glm::vec3(1.0F), TextureSource{{9, 9}, {kTexels, kTexels}, texels_}}};
    return shape;
  }
  void expect_texels(const Image& image, const Vec3d& linear_tint) {
    for (std::size_t row = 0; row < kTexels; ++row) {
      for (std::size_t column = 0; column < kTexels; ++column) {
        const std::uint8_t* texel = texels_.data() + 4 * (row * kTexels + column);
        const Vec3d decoded = test::decode_srgb(Vec3d(texel[0], texel[1], texel[2]) / 255.0);
        const auto expected = test::srgb_bytes(decoded * linear_tint);
        const Rgb found = image.at(column * kTexelPx + kTexelPx / 2, row * kTexelPx + kTexelPx / 2);
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 2.0) << "texel " << row << ", " << column;
      }
    }
  }
  test::Offscreen gpu_;
  const std::vector<std::uint8_t> texels_ = numbered_texels();
  std::vector<glm::vec3> places_;
};

TEST_F(Surface, ATexturesTopRowIsWhereVIsOne) { expect_texels(draw(textured()), Vec3d(1.0)); }

TEST_F(Surface, ABaseColourTintsTheTextureInLinearLight) {
  Shape shape = textured();
  const glm::vec3 tint(0.5F, 0.8F, 0.2F);
  shape.materials[0].base_color = tint;
  expect_texels(draw(shape), test::decode_srgb(Vec3d(tint)));
}

TEST_F(Surface, BetweenTexelsTheirLightIsMixed) {
  const Image image = draw(textured());
  // Pixel 13 is exactly the middle of texel 1, pixel 14 a ninth of the way on to texel 2.
  const double a = test::decode_srgb(texels_[4] / 255.0), b = test::decode_srgb(texels_[8] / 255.0);
  for (std::size_t step = 0; step <= kTexelPx; ++step) {
    const double t = static_cast<double>(step) / kTexelPx;
    const double expected = 255.0 * test::encode_srgb(a + (b - a) * t);
    EXPECT_NEAR(image.at(kTexelPx + kTexelPx / 2 + step, kTexelPx / 2)[0], expected, 2.0) << step;
  }
}

TEST_F(Surface, TextureCoordinatesBeyondOneRepeatTheTexture) {
  Shape shape = textured();
  const Image once = draw(shape);
  for (std::size_t i = 0; i < shape.texcoords.size(); i += 2) {
    shape.texcoords[i] += 3.0F;
    shape.texcoords[i + 1] -= 2.0F;
  }
  shape.rename();
  const Image again = draw(shape);
  for (std::size_t i = 0; i < once.rgb.size(); ++i) EXPECT_NEAR(again.rgb[i], once.rgb[i], 2);
}

TEST_F(Surface, EachPartShowsItsMaterialHoweverPartsAreScattered) {
  Shape shape = test::square(1.0F);
  const auto row = [&](float bottom, float top) {
    const auto first = static_cast<std::uint32_t>(4 * shape.indices.size() / 6);
    shape.indices.insert(shape.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    for (const glm::vec3 p : {glm::vec3(-1, bottom, 0), glm::vec3(1, bottom, 0), glm::vec3(1, top, 0), glm::vec3(-1, top, 0)}) {
      places_.push_back(p);
    }
    shape.texcoords.insert(shape.texcoords.end(), {0, 0, 1, 0, 1, 1, 0, 1});
  };
  shape.indices.clear();
  shape.texcoords.clear();
  shape.blocks.clear();
  for (int i = 0; i < 4; ++i) row(1.0F - 0.5F * static_cast<float>(i + 1), 1.0F - 0.5F * static_cast<float>(i));
  shape.vertex_count = places_.size();
  shape.add_key(places_, std::vector<glm::vec3>(places_.size(), glm::vec3(0, 0, 1)));
  // From the top: blue, red, blue, textured; named in another order, and one material that nothing shows.
  shape.materials = {
      {{1, 0, 0}, {}}, {{0, 1, 0}, {}}, {glm::vec3(1), TextureSource{{9, 9}, {kTexels, kTexels}, texels_}}, {{0, 0, 1}, {}}};
  shape.parts = {{18, 6, 2}, {12, 6, 3}, {6, 6, 0}, {0, 6, 3}};
  const Image image = draw(shape);
  const auto at_row = [&](std::size_t i) { return image.at(4, 9 * i + 4); };
  EXPECT_EQ(at_row(0), (Rgb{0, 0, 255}));
  EXPECT_EQ(at_row(1), (Rgb{255, 0, 0}));
  EXPECT_EQ(at_row(2), (Rgb{0, 0, 255}));
  EXPECT_GT(at_row(3)[1], 10) << "the texture";
  EXPECT_GT(at_row(3)[2], 10);
}

TEST_F(Surface, AMeshWithoutTextureCoordinatesIsDrawnInItsColour) {
  Shape shape = test::square(1.0F);
  shape.texcoords.clear();
  shape.blocks[0].resize(24);  // no tangents either
  shape.materials[0].base_color = {0, 1, 1};
  EXPECT_EQ(draw(shape).at(18, 18), (Rgb{0, 255, 255}));
}

TEST_F(Surface, AMomentBetweenKeyframesIsDrawnWhereItIs) {
  Shape shape = test::square(0.25F);
  shape.blocks.push_back(shape.blocks[0]);
  for (std::size_t i = 0; i < 12; i += 3) {
    shape.blocks[0][i] -= 0.75F;  // the left edge
    shape.blocks[1][i] += 0.75F;  // the right one
  }
  Picture picture = flat_picture();
  for (const float u : {0.0F, 0.5F, 1.0F}) {
    picture.items = {shape.item({0, 1}, {1.0F - u, u})};
    const Image image = draw(picture);
    for (std::size_t i = 0; i < 3; ++i) {
      const int expected = u == 0.5F * static_cast<float>(i) ? 255 : 0;
      EXPECT_EQ(image.at(4 + 14 * i - (i == 2 ? 1 : 0), 18)[0], expected) << "u " << u << ", place " << i;
    }
  }
}

/// The ground from above at a slant; a cell is a metre.
Picture ground_picture() {
  Picture picture;
  picture.size = {161, 91};  // odd: a row and a column of pixels lie exactly in the middle
  picture.grid = true;
  picture.view.eye = {0.0F, 3.0F, 6.0F};
  picture.view.view_from_world = glm::lookAt(picture.view.eye, glm::vec3(0.0F), glm::vec3(0.0F, 1.0F, 0.0F));
  picture.view.clip_from_view = glm::perspective(glm::radians(45.0F), 161.0F / 91.0F, 0.1F, 100.0F);
  picture.view.focus_m = glm::length(picture.view.eye);
  picture.light.ambient = 1.0F;
  return picture;
}

/// The pixel that shows a place.
std::pair<std::size_t, std::size_t> pixel_of(const Picture& picture, glm::vec3 place) {
  const glm::vec4 clip = picture.view.clip_from_view * picture.view.view_from_world * glm::vec4(place, 1.0F);
  const auto to_px = [](float ndc, std::uint32_t size) {
    return static_cast<std::size_t>((0.5F + 0.5F * ndc) * static_cast<float>(size));
  };
  return {to_px(clip.x / clip.w, picture.size.width), to_px(-clip.y / clip.w, picture.size.height)};
}

int brightness(const Image& image, std::pair<std::size_t, std::size_t> at) { return image.at(at.first, at.second)[0]; }

TEST_F(Surface, TheGroundHasALineEachMetreAndStrongerOnesEachTen) {
  const Picture picture = ground_picture();
  const Image image = draw(picture);
  for (const float z : {0.5F, 1.5F, 2.5F}) {
    EXPECT_GT(brightness(image, pixel_of(picture, {1, 0, z})), 30) << "on a line, z " << z;
    EXPECT_LT(brightness(image, pixel_of(picture, {1.5F, 0, z})), 8) << "between lines, z " << z;
    EXPECT_GT(brightness(image, pixel_of(picture, {0, 0, z})), brightness(image, pixel_of(picture, {1, 0, z})) + 20);
  }
  Picture without = picture;
  without.grid = false;
  EXPECT_EQ(draw(without), Image(picture.size));
}

TEST_F(Surface, TheGroundIsDarkOnALightBackground) {
  Picture picture = ground_picture();
  picture.background = glm::vec3(1.0F);
  const Image image = draw(picture);
  EXPECT_LT(brightness(image, pixel_of(picture, {0, 0, 1.5F})), 220);
  EXPECT_GT(brightness(image, pixel_of(picture, {1.5F, 0, 1.5F})), 250);
}

TEST_F(Surface, TheGroundIsSeenOnlyWhereNothingStandsBeforeIt) {
  Picture picture = ground_picture();
  Shape above = test::square(0.8F, 0.0F);
  above.materials[0].base_color = {0, 1, 0};
  DrawItem item = above.item();  // stands on edge, half of it under the ground
  picture.items = {item};
  const Image image = draw(picture);
  picture.grid = false;
  const Image without = draw(picture);
  bool ground_before_it = false;
  for (std::size_t y = 0; y < picture.size.height; ++y) {
    for (std::size_t x = 0; x < picture.size.width; ++x) {
      const bool upper = y < 45 && without.at(x, y)[1] > 200;
      EXPECT_TRUE(!upper || image.at(x, y) == without.at(x, y)) << "it stands before the ground at " << x << ", " << y;
      if (y > 47 && without.at(x, y)[1] > 200 && image.at(x, y) != without.at(x, y)) ground_before_it = true;
    }
  }
  EXPECT_TRUE(ground_before_it) << "its lower half is under the ground";
}

TEST_F(Surface, TheGroundFollowsWhatIsLookedAtAndGrowsWithTheDistance) {
  Picture near = ground_picture();
  Picture far = near;
  far.view.eye *= 100.0F;
  far.view.view_from_world = glm::lookAt(far.view.eye, glm::vec3(0.0F), glm::vec3(0.0F, 1.0F, 0.0F));
  far.view.clip_from_view = glm::perspective(glm::radians(45.0F), 161.0F / 91.0F, 10.0F, 10000.0F);
  far.view.focus_m *= 100.0F;
  const Image a = draw(near), b = draw(far);
  double difference = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) difference += std::abs(int{a.rgb[i]} - int{b.rgb[i]});
  EXPECT_LT(difference / static_cast<double>(a.rgb.size()), 0.5) << "a hundred times as far, cells of a hundred metres";
}

}  // namespace
}  // namespace tweend::render
