#include "server/animation/vertex_tangents.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace tweend::animation {
namespace {

/// A square in the xy plane that faces +z; its texture lies straight on it unless changed.
struct Square {
  explicit Square(float scale = 1.0F) : positions{0, 0, 0, scale, 0, 0, scale, scale, 0, 0, scale, 0} {}
  [[nodiscard]] Status run() { return compute_tangents(positions, normals, texcoords, indices, tangents); }
  std::vector<float> positions;
  std::vector<float> normals{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  std::vector<float> texcoords{0, 0, 1, 0, 1, 1, 0, 1};
  std::vector<std::uint32_t> indices{0, 1, 2, 0, 2, 3};
  std::vector<float> tangents = std::vector<float>(12, -7.0F);
};

void expect_all(const Square& square, double x, double y, double z) {
  const double expected[] = {x, y, z};
  for (std::size_t i = 0; i < square.tangents.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(square.tangents[i]), expected[i % 3], 1e-6) << "float " << i;
  }
}

void expect_unit_and_perpendicular(const Square& square) {
  for (std::size_t i = 0; i < square.tangents.size(); i += 3) {
    double dot = 0.0, square_length = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double t = static_cast<double>(square.tangents[i + k]);
      dot += t * static_cast<double>(square.normals[i + k]);
      square_length += t * t;
    }
    EXPECT_NEAR(dot, 0.0, 1e-6);
    EXPECT_NEAR(std::sqrt(square_length), 1.0, 1e-6);
  }
}

TEST(ComputeTangents, FollowsGrowingU) {
  Square straight;
  ASSERT_TRUE(straight.run());
  expect_all(straight, 1, 0, 0);

  Square turned;
  turned.texcoords = {0, 0, 0, 1, -1, 1, -1, 0};  // u grows towards −y, v along +x
  ASSERT_TRUE(turned.run());
  expect_all(turned, 0, -1, 0);

  Square mirrored;
  mirrored.texcoords = {1, 0, 0, 0, 0, 1, 1, 1};
  ASSERT_TRUE(mirrored.run());
  expect_all(mirrored, -1, 0, 0);

  Square sheared;  // u = x, v = y − x: along constant v, u grows towards (1, 1)
  sheared.texcoords = {0, 0, 1, -1, 1, 0, 0, 1};
  ASSERT_TRUE(sheared.run());
  expect_all(sheared, std::sqrt(0.5), std::sqrt(0.5), 0);
}

TEST(ComputeTangents, IsRightAtEveryScaleOfFloats) {
  for (const float scale : {1e-42F, 1e-20F, 1e15F, 3e38F}) {
    for (const float texture_scale : {1e-40F, 1e-20F, 1.0F, 1e20F}) {
      Square square(scale);
      for (float& t : square.texcoords) t *= texture_scale;
      ASSERT_TRUE(square.run());
      expect_all(square, 1, 0, 0);
    }
  }
}

TEST(ComputeTangents, StaysPerpendicularToTiltedNormals) {
  Square square;
  const float s = std::sqrt(0.5F);
  square.normals = {s, 0, s, 0, s, s, -s, 0, s, 0.6F, 0, 0.8F};
  ASSERT_TRUE(square.run());
  expect_unit_and_perpendicular(square);
  EXPECT_GT(square.tangents[0], 0.0F);
}

TEST(ComputeTangents, AnyPerpendicularWhereThereIsNone) {
  Square no_area;
  no_area.texcoords = {0, 0, 1, 1, 2, 2, 3, 3};
  Square no_triangle;
  no_triangle.indices = {};
  Square along_normal;
  along_normal.normals = {1, 0, 0, 1, 0, 0, -1, 0, 0, 1, 0, 0};
  Square empty_triangle;
  empty_triangle.indices = {0, 0, 1, 2, 2, 3};
  for (Square* square : {&no_area, &no_triangle, &along_normal, &empty_triangle}) {
    ASSERT_TRUE(square->run());
    expect_unit_and_perpendicular(*square);
  }
}

TEST(ComputeTangents, IsUnitEvenWithoutANormal) {
  Square square;
  square.normals = {0, 0, 0, 0, 0, 0, 0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0, 0};
  ASSERT_TRUE(square.run());
  expect_all(square, 1, 0, 0);
}

TEST(ComputeTangents, RefusesLengthsThatDoNotFitAndLeavesTheOutputUntouched) {
  const auto expect_refused = [](auto spoil) {
    Square square;
    spoil(square);
    const Status status = square.run();
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::Internal);
    for (const float value : square.tangents) EXPECT_EQ(value, -7.0F);
  };
  expect_refused([](Square& s) { s.positions.pop_back(); });
  expect_refused([](Square& s) { s.normals.resize(9); });
  expect_refused([](Square& s) { s.texcoords.pop_back(); });
  expect_refused([](Square& s) { s.indices.pop_back(); });
  expect_refused([](Square& s) { s.tangents.resize(9); });
}

}  // namespace
}  // namespace tweend::animation
