#include "server/animation/vertex_normals.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace tweend::animation {
namespace {

void expect_direction(std::span<const float> normals, std::size_t vertex, double x, double y, double z) {
  EXPECT_NEAR(static_cast<double>(normals[3 * vertex]), x, 1e-6) << "vertex " << vertex;
  EXPECT_NEAR(static_cast<double>(normals[3 * vertex + 1]), y, 1e-6) << "vertex " << vertex;
  EXPECT_NEAR(static_cast<double>(normals[3 * vertex + 2]), z, 1e-6) << "vertex " << vertex;
}

/// A unit square in the xy plane and a fin of height `fin` that stands on its left edge, into +z.
struct Corner {
  explicit Corner(float scale, float fin = 1.0F)
      : positions{0, 0, 0, scale, 0, 0, scale, scale, 0, 0, scale, 0, 0, 0, fin * scale} {}
  std::vector<float> positions;
  std::vector<std::uint32_t> indices{0, 1, 2, 0, 2, 3, 0, 3, 4};
  std::vector<float> normals = std::vector<float>(15, -7.0F);
};

TEST(ComputeNormals, WeighsTrianglesByArea) {
  for (const float fin : {1.0F, 3.0F}) {
    Corner corner(1.0F, fin);
    ASSERT_TRUE(compute_normals(corner.positions, corner.indices, corner.normals));
    // Vertex 0: two triangles of area 1/2 that face +z, one of area fin/2 that faces +x. Vertex 3: one and one.
    const double f = static_cast<double>(fin);
    expect_direction(corner.normals, 0, f / std::hypot(2.0, f), 0, 2.0 / std::hypot(2.0, f));
    expect_direction(corner.normals, 3, f / std::hypot(1.0, f), 0, 1.0 / std::hypot(1.0, f));
    expect_direction(corner.normals, 1, 0, 0, 1);
    expect_direction(corner.normals, 4, 1, 0, 0);
  }
}

TEST(ComputeNormals, IsRightAtEveryScaleOfFloats) {
  Corner reference(1.0F);
  ASSERT_TRUE(compute_normals(reference.positions, reference.indices, reference.normals));
  for (const float scale : {1e-42F, 1e-38F, 1e-20F, 1e-5F, 1e5F, 1e15F, 1e30F, 3e38F}) {
    Corner corner(scale);
    ASSERT_TRUE(compute_normals(corner.positions, corner.indices, corner.normals));
    for (std::size_t i = 0; i < 15; ++i) EXPECT_NEAR(corner.normals[i], reference.normals[i], 1e-6F) << "scale " << scale;
  }
}

TEST(ComputeNormals, IsRightWhereTinyAndHugeTrianglesShareAMesh) {
  Corner huge(1e15F);
  const Corner tiny(1e-15F);
  huge.positions.insert(huge.positions.end(), tiny.positions.begin(), tiny.positions.end());
  for (const std::uint32_t index : tiny.indices) huge.indices.push_back(index + 5);
  huge.normals.resize(30);
  ASSERT_TRUE(compute_normals(huge.positions, huge.indices, huge.normals));
  for (std::size_t i = 0; i < 15; ++i) EXPECT_NEAR(huge.normals[i], huge.normals[i + 15], 1e-6F);
}

TEST(ComputeNormals, PointOutwardsOnASphere) {
  constexpr std::uint32_t kRings = 40;
  constexpr std::uint32_t kSectors = 80;
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t r = 0; r <= kRings; ++r) {
    for (std::uint32_t s = 0; s < kSectors; ++s) {
      const double polar = std::numbers::pi * r / kRings;
      const double around = 2 * std::numbers::pi * s / kSectors;
      positions.push_back(static_cast<float>(std::sin(polar) * std::cos(around)));
      positions.push_back(static_cast<float>(std::cos(polar)));
      positions.push_back(static_cast<float>(std::sin(polar) * std::sin(around)));
      if (r == kRings) continue;
      const std::uint32_t here = r * kSectors + s, beside = r * kSectors + (s + 1) % kSectors;
      indices.insert(indices.end(), {here, beside, beside + kSectors, here, beside + kSectors, here + kSectors});
    }
  }
  std::vector<float> normals(positions.size());
  ASSERT_TRUE(compute_normals(positions, indices, normals));
  for (std::size_t i = kSectors * 3; i < normals.size() - kSectors * 3; ++i) EXPECT_NEAR(normals[i], positions[i], 0.02F);
}

TEST(ComputeNormals, VerticesOfEmptyTrianglesOrOfNoneGetUp) {
  const std::vector<float> positions{0.1F, 0.1F, 0.1F, 0.2F, 0.2F, 0.2F, 0.4F, 0.4F, 0.4F, 5, 6, 7};
  const std::vector<std::uint32_t> indices{0, 1, 2, 0, 0, 1};  // on one line, and with a corner twice
  std::vector<float> normals(12, -7.0F);
  ASSERT_TRUE(compute_normals(positions, indices, normals));
  for (std::size_t v = 0; v < 4; ++v) expect_direction(normals, v, 0, 1, 0);
}

TEST(ComputeNormals, AreUnitEvenWhereTrianglesCancelOut) {
  const std::vector<float> positions{0.3F, 0, 0.1F, 1.7F, 0.2F, 0, 0, 1.1F, 0.9F};
  const std::vector<std::uint32_t> indices{0, 1, 2, 2, 1, 0};
  std::vector<float> normals(9);
  ASSERT_TRUE(compute_normals(positions, indices, normals));
  for (std::size_t v = 0; v < 9; v += 3) EXPECT_NEAR(std::hypot(normals[v], normals[v + 1], normals[v + 2]), 1.0F, 1e-6F);
}

TEST(ComputeNormals, AcceptsNothing) { EXPECT_TRUE(compute_normals({}, {}, {})); }

TEST(ComputeNormals, RefusesLengthsThatDoNotFitAndLeavesTheOutputUntouched) {
  Corner corner(1.0F);
  const auto expect_refused = [&](std::span<const float> positions, std::span<const std::uint32_t> indices,
                                  std::span<float> out) {
    const Status status = compute_normals(positions, indices, out);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::Internal);
    for (const float value : corner.normals) EXPECT_EQ(value, -7.0F);
  };
  const std::span<float> out(corner.normals);
  expect_refused(std::span(corner.positions).first(14), corner.indices, out.first(14));
  expect_refused(corner.positions, std::span(corner.indices).first(8), out);
  expect_refused(corner.positions, corner.indices, out.first(12));
}

}  // namespace
}  // namespace tweend::animation
