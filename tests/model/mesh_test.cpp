#include "server/model/mesh.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

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

class MeshSurface : public testing::Test {
 protected:
  /// Two triangles that look so, or why not.
  static Result<MeshPtr> make(Surface surface) { return Mesh::make(4, {0, 1, 2, 0, 2, 3}, {}, std::move(surface)); }
  static std::string error_of(Surface surface) {
    const auto mesh = make(std::move(surface));
    return mesh ? "no error" : mesh.error().message;
  }
  static Material red() { return {"red", {1, 0, 0}, nullptr}; }
};

TEST_F(MeshSurface, PartsCoverAllTrianglesInOrder) {
  EXPECT_TRUE(make({}));
  EXPECT_TRUE(make({{red()}, {{0, 6, 0}}}));
  const auto mesh = make({{red(), Material{}}, {{0, 3, 1}, {3, 3, 0}}});
  ASSERT_TRUE(mesh);
  EXPECT_EQ((*mesh)->surface().parts[1], (MeshPart{3, 3, 0}));
  EXPECT_EQ((*mesh)->surface().materials[0].name, "red");
}

TEST_F(MeshSurface, RefusesPartsThatDoNot) {
  EXPECT_EQ(error_of({{red()}, {}}), "expected parts of all 6 indices, found 0");
  EXPECT_EQ(error_of({{red()}, {{0, 3, 0}}}), "expected parts of all 6 indices, found 3");
  EXPECT_EQ(error_of({{red()}, {{3, 3, 0}}}), "expected a part of whole triangles from index 0 of 6, found 3 from 3");
  for (const std::uint32_t count : {0U, 2U, 4U, 9U, 4294967295U}) {
    EXPECT_EQ(error_of({{red()}, {{0, count, 0}}}),
              "expected a part of whole triangles from index 0 of 6, found " + std::to_string(count) + " from 0");
  }
  EXPECT_NE(error_of({{red()}, {{0, 3, 0}, {0, 3, 0}}}), "no error") << "twice the same";
  EXPECT_NE(error_of({{red()}, {{3, 3, 0}, {0, 3, 0}}}), "no error") << "the wrong order";
}

TEST_F(MeshSurface, RefusesMaterialsThatAreNotThere) {
  EXPECT_EQ(error_of({{red()}, {{0, 6, 1}}}), "expected one of 1 materials, found 1");
  EXPECT_EQ(error_of({{}, {{0, 6, 0}}}), "expected one of 0 materials, found 0");
}

TEST_F(MeshSurface, IsContentToo) {
  const auto hash = [](Surface surface) { return (*make(std::move(surface)))->hash(); };
  const auto one = [](Material material) { return Surface{{std::move(material)}, {{0, 6, 0}}}; };
  const ContentHash base = hash(one(red()));
  EXPECT_EQ(hash(one(red())), base);
  EXPECT_NE(hash({}), base);
  EXPECT_NE(hash(one({"blue", {1, 0, 0}, nullptr})), base);
  EXPECT_NE(hash(one({"red", {1, 0, 0.5F}, nullptr})), base);
  EXPECT_NE(hash(one({"red", {1, 0, 0}, *Image::make(1, 1, {0, 0, 0, 0})})), base);
  EXPECT_NE(hash({{red(), red()}, {{0, 6, 0}}}), base);
  EXPECT_NE(hash({{red(), red()}, {{0, 3, 0}, {3, 3, 1}}}), hash({{red(), red()}, {{0, 3, 1}, {3, 3, 0}}}));
}

}  // namespace
}  // namespace tweend::model
