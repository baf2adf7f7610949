#include "server/model/vertex_key.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tweend::model {
namespace {

const std::vector<float> kSquare{0, 0, 0, 1, 0, 0, 1, 0, -1, 0, 0, -1};  // in the ground, facing up

MeshPtr square(bool with_texcoords = false) {
  return *Mesh::make(4, {0, 1, 2, 0, 2, 3}, with_texcoords ? std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1} : std::vector<float>{});
}

TEST(VertexKey, NamesBothCountsWhereTheyDiffer) {
  const auto key = VertexKey::make(*square(), std::vector<float>(21));
  ASSERT_FALSE(key);
  EXPECT_EQ(key.error().code, ErrorCode::InvalidParams);
  EXPECT_EQ(key.error().path, "positions");
  EXPECT_NE(key.error().message.find("4 vertices"), std::string::npos);
  EXPECT_NE(key.error().message.find("found 21 for 7"), std::string::npos) << key.error().message;
  EXPECT_EQ(VertexKey::make(*square(), kSquare, std::vector<float>(9)).error().path, "normals");
}

TEST(VertexKey, RefusesNumbersThatAreNotFinite) {
  for (const float bad : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    auto positions = kSquare;
    positions[7] = bad;
    const auto key = VertexKey::make(*square(), positions);
    ASSERT_FALSE(key);
    EXPECT_NE(key.error().message.find("position 7"), std::string::npos) << key.error().message;
  }
}

TEST(VertexKey, ComputesNormalsThatAreMissing) {
  const auto key = VertexKey::make(*square(), kSquare);
  ASSERT_TRUE(key);
  for (std::size_t i = 0; i < 12; i += 3) {
    EXPECT_NEAR((*key)->normals()[i], 0, 1e-6);
    EXPECT_NEAR((*key)->normals()[i + 1], 1, 1e-6);
    EXPECT_NEAR((*key)->normals()[i + 2], 0, 1e-6);
  }
  EXPECT_TRUE((*key)->tangents().empty());
}

TEST(VertexKey, NormalisesNormalsAndReplacesZeroOnes) {
  const auto key = VertexKey::make(*square(), kSquare, std::vector<float>{3, 0, 4, 0, 0, 0, 0, -5, 0, 1e-20F, 0, 0});
  ASSERT_TRUE(key);
  const auto n = (*key)->normals();
  EXPECT_NEAR(n[0], 0.6, 1e-6);
  EXPECT_NEAR(n[2], 0.8, 1e-6);
  EXPECT_NEAR(n[4], 1, 1e-6) << "computed";
  EXPECT_NEAR(n[7], -1, 1e-6);
  EXPECT_NEAR(n[9], 1, 1e-6) << "short, but a direction";
}

TEST(VertexKey, HasTangentsWhereTheMeshHasTextureCoordinates) {
  const auto key = VertexKey::make(*square(true), kSquare);
  ASSERT_TRUE(key);
  ASSERT_EQ((*key)->tangents().size(), 12U);
  EXPECT_NEAR((*key)->tangents()[0], 1, 1e-6) << "u grows along +X";
}

TEST(VertexKey, KnowsItsBoundsAndIsNamedByItsContent) {
  const auto a = *VertexKey::make(*square(), kSquare);
  EXPECT_EQ(a->bounds(), (Bounds{{0, 0, -1}, {1, 0, 0}}));
  EXPECT_EQ(a->hash(), (*VertexKey::make(*square(), kSquare))->hash());
  auto moved = kSquare;
  moved[1] = 0.001F;
  EXPECT_NE(a->hash(), (*VertexKey::make(*square(), moved))->hash());
}

}  // namespace
}  // namespace tweend::model
