#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "tests/render/support/flat.hpp"
#include "tests/render/support/light.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/shape.hpp"

// What glTF's materials say beside a colour and a texture: colours of vertices, alpha with a cutoff, no light, edges.

namespace tweend::render {
namespace {

using test::Image;
using test::Rgb;
using test::Shape;
using test::Vec3d;

constexpr Size kSize{36, 36};

void set_colors(Shape& shape, const std::vector<glm::vec4>& of_corners) {
  shape.colors.clear();
  for (const glm::vec4& c : of_corners) shape.colors.insert(shape.colors.end(), {c.x, c.y, c.z, c.w});
  shape.rename();
}

class Materials : public testing::Test {
 protected:
  Image draw(const std::vector<DrawItem>& items, Size size = kSize) {
    Picture picture = test::flat_picture(size);
    picture.items = items;
    return gpu_.draw(picture);
  }
  static void expect_color(const Rgb& found, const Vec3d& linear, double tolerance = 1.5) {
    const auto expected = test::srgb_bytes(linear);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << "channel " << c;
  }
  test::Offscreen gpu_;
};

TEST_F(Materials, ColoursOfVerticesAreLinearAndTintTheBaseColour) {
  Shape shape = test::square(1.0F);
  shape.materials[0].base_color = {0.5F, 0.8F, 1.0F};
  set_colors(shape, std::vector<glm::vec4>(4, glm::vec4(0.25F, 0.5F, 0.75F, 1.0F)));
  expect_color(draw({shape.item()}).at(18, 18), test::decode_srgb(Vec3d(0.5, 0.8, 1.0)) * Vec3d(0.25, 0.5, 0.75));
}

TEST_F(Materials, BetweenVerticesTheirColoursAreMixedInLinearLight) {
  Shape shape = test::square(1.0F);
  set_colors(shape, {glm::vec4(0, 0, 0, 1), glm::vec4(1), glm::vec4(1), glm::vec4(0, 0, 0, 1)});
  const Image image = draw({shape.item()});
  for (const std::size_t x : {3U, 12U, 18U, 30U}) {
    expect_color(image.at(x, 20), Vec3d((static_cast<double>(x) + 0.5) / kSize.width));
  }
}

TEST_F(Materials, AMeshWithoutColoursIsDrawnInItsOwnAfterOneThatHasSome) {
  Shape colored = test::square(1.0F, -1.0F);
  set_colors(colored, std::vector<glm::vec4>(4, glm::vec4(0, 1, 0, 1)));
  const Shape plain = test::square(0.5F);
  const Image image = draw({colored.item(), plain.item()});
  EXPECT_EQ(image.at(18, 18), (Rgb{255, 255, 255}));
  EXPECT_EQ(image.at(2, 2), (Rgb{0, 255, 0}));
}

TEST_F(Materials, WhatIsUnlitShowsItsColourWhateverTheLight) {
  Shape unlit = test::square(1.0F, 0.0F, glm::vec3(0.0F, 0.0F, 1.0F));
  unlit.materials[0].base_color = {0.2F, 0.6F, 0.8F};
  unlit.materials[0].unlit = true;
  Picture picture = test::flat_picture(kSize);
  picture.items = {unlit.item()};
  for (const float strength : {0.0F, 1.0F}) {
    picture.light.ambient = picture.light.diffuse = picture.light.specular = strength;
    const Image image = gpu_.draw(picture);
    EXPECT_EQ(image.at(18, 18), (Rgb{51, 153, 204})) << "light of " << strength;
  }
}

/// Two texels side by side: the left one lets through, as far as `alpha` says.
Shape half_window(const std::vector<std::uint8_t>& texels) {
  Shape shape = test::square(1.0F);
  shape.materials[0].base_color_texture = TextureSource{{20, texels[3]}, {2, 1}, texels};
  shape.materials[0].wrap_u = TextureWrap::ClampToEdge;
  return shape;
}

TEST_F(Materials, WhatHasLessAlphaThanTheCutoffIsNotDrawn) {
  const std::vector<std::uint8_t> texels{255, 0, 0, 40, 255, 0, 0, 255};
  Shape window = half_window(texels);
  window.materials[0].alpha_cutoff = 0.5F;
  Shape behind = test::square(1.0F, -1.0F);
  behind.materials[0].base_color = {0, 0, 1};
  for (const bool last : {false, true}) {
    const Image image = draw(last ? std::vector{behind.item(), window.item()} : std::vector{window.item(), behind.item()});
    EXPECT_EQ(image.at(6, 18), (Rgb{0, 0, 255})) << "seen through, drawn " << (last ? "last" : "first");
    EXPECT_EQ(image.at(30, 18), (Rgb{255, 0, 0}));
  }
}

TEST_F(Materials, WithoutACutoffAlphaIsNotLookedAt) {
  const std::vector<std::uint8_t> texels{255, 0, 0, 41, 255, 0, 0, 255};
  const Shape window = half_window(texels);
  EXPECT_EQ(draw({window.item()}).at(6, 18), (Rgb{255, 0, 0}));
}

TEST_F(Materials, AlphaIsTheProductOfTextureMaterialAndVertex) {
  const std::vector<std::uint8_t> texels{255, 0, 0, 204, 255, 0, 0, 204};  // 0.8
  for (const auto& [alpha, of_vertices, drawn] :
       {std::tuple{0.7F, 1.0F, true}, {0.6F, 1.0F, false}, {1.0F, 0.7F, true}, {1.0F, 0.6F, false}, {0.8F, 0.8F, true}}) {
    Shape shape = half_window(texels);
    shape.materials[0].alpha = alpha;
    shape.materials[0].alpha_cutoff = 0.5F;
    set_colors(shape, std::vector<glm::vec4>(4, glm::vec4(1, 1, 1, of_vertices)));
    EXPECT_EQ(draw({shape.item()}).at(18, 18)[0], drawn ? 255 : 0) << alpha << ", " << of_vertices;
  }
}

constexpr int kTexels = 4;   // a side
constexpr int kTexelPx = 9;  // odd, so that one pixel's centre is the texel's

/// Which texel is shown `at` so many texels from the texture's edge.
int wrapped(TextureWrap wrap, int at) {
  if (wrap == TextureWrap::ClampToEdge) return std::clamp(at, 0, kTexels - 1);
  const int in_two = (at % (2 * kTexels) + 2 * kTexels) % (2 * kTexels);
  if (wrap == TextureWrap::Repeat) return in_two % kTexels;
  return in_two < kTexels ? in_two : 2 * kTexels - 1 - in_two;
}

TEST_F(Materials, BeyondItsEdgesATextureIsRepeatedMirroredOrHeld) {
  constexpr int kStep = 255 / (kTexels - 1);
  std::vector<std::uint8_t> texels;
  for (int i = 0; i < kTexels * kTexels; ++i) {
    for (const int c : {kStep * (i % kTexels), kStep * (i / kTexels), 128, 255}) {
      texels.push_back(static_cast<std::uint8_t>(c));
    }
  }
  const auto center_px = [](int texel) { return std::size_t{kTexelPx} * static_cast<std::size_t>(texel) + kTexelPx / 2; };
  constexpr int kShown = 3 * kTexels;  // from one texture before to one behind
  constexpr std::uint32_t kSide = kShown * kTexelPx;
  constexpr std::array kWraps{TextureWrap::Repeat, TextureWrap::MirroredRepeat, TextureWrap::ClampToEdge};
  for (const TextureWrap u : kWraps) {
    for (const TextureWrap v : kWraps) {
      SCOPED_TRACE(testing::Message() << "u " << static_cast<int>(u) << ", v " << static_cast<int>(v));
      Shape shape = test::square(1.0F);
      shape.texcoords = {-1, -1, 2, -1, 2, 2, -1, 2};
      // One texture for all: how it is wrapped is the material's.
      shape.materials[0].base_color_texture = TextureSource{{21, 1}, {kTexels, kTexels}, texels};
      shape.materials[0].wrap_u = u;
      shape.materials[0].wrap_v = v;
      const Image image = draw({shape.item()}, {kSide, kSide});
      for (int row = 0; row < kShown; ++row) {
        for (int column = 0; column < kShown; ++column) {
          const Rgb found = image.at(center_px(column), center_px(row));
          EXPECT_NEAR(found[0], kStep * wrapped(u, column - kTexels), 2) << "row " << row << ", " << column;
          EXPECT_NEAR(found[1], kStep * wrapped(v, row - kTexels), 2) << "row " << row << ", " << column;
        }
      }
    }
  }
}

}  // namespace
}  // namespace tweend::render
