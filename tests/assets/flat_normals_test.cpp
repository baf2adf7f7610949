#include "server/assets/flat_normals.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tweend::assets {
namespace {

using ::testing::ElementsAre;

TEST(FlatNormals, KeepTheVerticesOfAPlane) {
  const std::vector<float> square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  std::vector<std::uint32_t> indices{0, 1, 2, 0, 2, 3};
  const FlatNormals flat = compute_flat_normals(square, indices);
  EXPECT_TRUE(flat.copies.empty());
  EXPECT_THAT(indices, ElementsAre(0, 1, 2, 0, 2, 3));
  EXPECT_THAT(flat.normals, ElementsAre(0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1));
}

TEST(FlatNormals, RepeatVerticesOnAnEdge) {
  // A roof: one side in the plane z = 0, the other in x = 0; they share the edge along y.
  const std::vector<float> roof{0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1};
  std::vector<std::uint32_t> indices{0, 2, 1, 0, 1, 3};
  const FlatNormals flat = compute_flat_normals(roof, indices);
  EXPECT_THAT(flat.copies, ElementsAre(0, 1));
  EXPECT_THAT(indices, ElementsAre(0, 2, 1, 4, 5, 3));
  EXPECT_THAT(flat.normals, ElementsAre(0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 0, 0));
}

TEST(FlatNormals, ReuseACopyOfTheSameDirection) {
  // Two triangles of each of two directions around vertex 0.
  const std::vector<float> fan{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1};
  std::vector<std::uint32_t> indices{0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5};
  const FlatNormals flat = compute_flat_normals(fan, indices);
  EXPECT_THAT(flat.copies, ElementsAre(0, 3));
  EXPECT_EQ(indices[6], indices[9]);
}

TEST(FlatNormals, HaveADirectionForEmptyTriangles) {
  const std::vector<float> line{0, 0, 0, 1, 0, 0, 2, 0, 0};
  std::vector<std::uint32_t> indices{0, 1, 2};
  EXPECT_THAT(compute_flat_normals(line, indices).normals, ElementsAre(0, 1, 0, 0, 1, 0, 0, 1, 0));
}

}  // namespace
}  // namespace tweend::assets
