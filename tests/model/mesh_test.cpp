#include "server/model/mesh.hpp"

#include <gtest/gtest.h>

namespace tweend::model {
namespace {

TEST(Mesh, RefusesWhatIsNoMesh) {
  EXPECT_FALSE(Mesh::make(0, {0, 0, 0}));
  EXPECT_FALSE(Mesh::make(3, {}));
  EXPECT_FALSE(Mesh::make(3, {0, 1}));
  EXPECT_FALSE(Mesh::make(3, {0, 1, 2}, {0, 0}));
  const auto beyond = Mesh::make(3, {0, 1, 2, 0, 1, 3});
  ASSERT_FALSE(beyond);
  EXPECT_NE(beyond.error().message.find("found 3 at position 5"), std::string::npos) << beyond.error().message;
}

TEST(Mesh, EqualContentHasEqualNames) {
  const auto make = [](std::vector<std::uint32_t> indices, std::vector<float> uvs = {}) {
    return (*Mesh::make(4, std::move(indices), std::move(uvs)))->hash();
  };
  EXPECT_EQ(make({0, 1, 2}), make({0, 1, 2}));
  EXPECT_NE(make({0, 1, 2}), make({0, 2, 1}));
  EXPECT_NE(make({0, 1, 2}), make({0, 1, 2}, {0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_NE((*Mesh::make(5, {0, 1, 2}))->hash(), make({0, 1, 2})) << "the number of vertices is content too";
}

}  // namespace
}  // namespace tweend::model
