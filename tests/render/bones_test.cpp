#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <vector>

#include "tests/render/support/flat.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/shape.hpp"

// Joints and bones, pixel by pixel, seen without perspective.

namespace tweend::render {
namespace {

using test::Image;
using test::Rgb;
using test::Shape;

constexpr std::uint32_t kSide = 200;
constexpr Size kSize{kSide, kSide};
const Rgb kNothing{0, 0, 0};

BoneSource bone(const glm::vec3& parent, const glm::vec3& joint, float radius) {
  BoneSource source;
  source.joint = joint;
  source.parent = parent;
  source.radius = radius;
  source.side = {0.0F, 0.0F, 1.0F};
  return source;
}

/// What the pixel at x, y of the plane shows.
Rgb at(const Image& image, float x, float y) {
  const auto px = [](float value) { return static_cast<std::size_t>((0.5F + 0.5F * value) * kSide); };
  return image.at(px(x), px(-y));
}

bool is_joint(const Rgb& c) { return c[0] > 150 && c[0] > c[1] + 50 && c[1] > c[2] + 50; }
bool is_bone(const Rgb& c) { return c[0] > 100 && c[1] > 0.9 * c[0] && c[2] > 0.7 * c[0]; }

class Bones : public testing::Test {
 protected:
  Image draw(const std::vector<BoneSource>& bones, const std::vector<BoneSource>& over = {},
             const std::vector<DrawItem>& items = {}) {
    Picture picture = test::flat_picture(kSize);
    picture.bones = bones;
    picture.bones_over = over;
    picture.items = items;
    return gpu_.draw(picture);
  }
  test::Offscreen gpu_;
};

TEST_F(Bones, ALoneJointIsABallOfItsRadius) {
  const Image image = draw({bone({0.2F, 0.1F, 0}, {0.2F, 0.1F, 0}, 0.3F)});
  for (std::size_t y = 0; y < kSide; ++y) {
    for (std::size_t x = 0; x < kSide; ++x) {
      const auto to_plane = [](std::size_t px) { return (static_cast<float>(px) + 0.5F) / (0.5F * kSide) - 1.0F; };
      const float from = glm::distance(glm::vec2(to_plane(x), -to_plane(y)), glm::vec2(0.2F, 0.1F));
      // It is a polyhedron within the ball: at its rim a little is missing.
      EXPECT_TRUE(from > 0.28F || is_joint(image.at(x, y))) << x << ", " << y;
      EXPECT_TRUE(from < 0.31F || image.at(x, y) == kNothing) << x << ", " << y;
    }
  }
}

TEST_F(Bones, ABoneLeadsFromTheParentToTheJointWideNearTheParent) {
  const Image image = draw({bone({-0.5F, -0.8F, 0}, {-0.5F, 0.8F, 0}, 0.05F)});
  EXPECT_TRUE(is_bone(at(image, -0.5F, -0.7F)));
  EXPECT_TRUE(is_bone(at(image, -0.5F, 0.7F)));
  EXPECT_TRUE(is_joint(at(image, -0.5F, 0.8F)));
  EXPECT_TRUE(is_bone(at(image, -0.5F + 0.13F, -0.56F))) << "its waist, a tenth of its length to each side";
  EXPECT_EQ(at(image, -0.5F + 0.18F, -0.56F), kNothing);
  EXPECT_EQ(at(image, -0.5F + 0.1F, 0.5F), kNothing) << "it is pointed";
  EXPECT_EQ(at(image, -0.5F, -0.85F), kNothing) << "it begins at the parent";
}

TEST_F(Bones, ABoneWithoutLengthIsNothingButItsBall) {
  BoneSource still = bone({0, 0, 0}, {0, 0, 0}, 0.2F);
  const Image ball = draw({still});
  still.radius = 0.0F;
  EXPECT_EQ(draw({still}), Image(kSize));
  for (std::size_t i = 0; i < ball.rgb.size(); i += 3) EXPECT_FALSE(is_bone({ball.rgb[i], ball.rgb[i + 1], ball.rgb[i + 2]}));
}

TEST_F(Bones, OneDrawShowsAllAsManyDo) {
  std::vector<BoneSource> bones;
  for (int i = 0; i < 9; ++i) {
    const float x = -0.8F + 0.2F * static_cast<float>(i);
    bones.push_back(bone({x, -0.6F, 0}, {x, 0.1F * static_cast<float>(i) - 0.3F, 0}, 0.03F));
  }
  Image all(kSize);
  for (const BoneSource& one : bones) {
    const Image image = draw({one});
    for (std::size_t i = 0; i < all.rgb.size(); ++i) all.rgb[i] = std::max(all.rgb[i], image.rgb[i]);
  }
  EXPECT_EQ(draw(bones), all) << "they stand side by side";
}

TEST_F(Bones, AMeshHidesBonesBehindItButNotThoseOverIt) {
  Shape wall = test::square(0.9F);
  wall.materials[0].base_color = {0, 0, 1};
  const std::vector<BoneSource> behind{bone({0, -0.5F, -2}, {0, 0.5F, -2}, 0.1F)};
  const Image hidden = draw(behind, {}, {wall.item()});
  const Image over = draw({}, behind, {wall.item()});
  EXPECT_EQ(at(hidden, 0, 0), (Rgb{0, 0, 255}));
  EXPECT_EQ(at(hidden, 0, 0.5F), (Rgb{0, 0, 255}));
  EXPECT_TRUE(is_bone(at(over, 0, 0)));
  EXPECT_TRUE(is_joint(at(over, 0, 0.5F)));
  EXPECT_EQ(at(over, 0.5F, 0.5F), (Rgb{0, 0, 255}));
}

TEST_F(Bones, OfTwoOverAMeshTheNearerHidesTheOther) {
  Shape wall = test::square(0.9F);
  const BoneSource ball = bone({0, 0, 0}, {0, 0, 0}, 0.2F), further = bone({0, -0.9F, -1}, {0, 0.9F, -1}, 0.0F);
  for (const auto& bones : {std::vector{ball, further}, std::vector{further, ball}}) {
    const Image image = draw({}, bones, {wall.item()});
    EXPECT_TRUE(is_joint(at(image, 0, 0)));
    EXPECT_TRUE(is_bone(at(image, 0, 0.5F)));
  }
}

TEST_F(Bones, AMirroredActorBeforeThemDoesNotTurnThemInsideOut) {
  Shape wall = test::square(0.1F);
  DrawItem item = wall.item();
  item.world_from_model[0][0] = -1.0F;
  const std::vector<BoneSource> bones{bone({0.5F, -0.5F, 0}, {0.5F, 0.5F, 0}, 0.1F)};
  const Image with = draw(bones, {}, {item}), without = draw(bones);
  EXPECT_EQ(at(with, 0.5F, 0.5F), at(without, 0.5F, 0.5F));
  EXPECT_EQ(at(with, 0.5F, 0.0F), at(without, 0.5F, 0.0F));
}

}  // namespace
}  // namespace tweend::render
