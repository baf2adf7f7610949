#include "server/assets/vertex_classes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <vector>

using testing::ElementsAre;

namespace tweend::assets {
namespace {

TEST(VertexClasses, AllCornersAreOneAtFirst) {
  const VertexClasses classes(3);
  EXPECT_THAT(classes.vertex_of_corner(), ElementsAre(0, 0, 0));
  EXPECT_EQ(classes.count(), 1U);
  EXPECT_EQ(VertexClasses(0).count(), 0U);
}

TEST(VertexClasses, NumbersInOrderOfFirstUse) {
  const std::vector<ObjCorner> corners{{7, -1, -1}, {3, -1, -1}, {7, -1, -1}, {0, -1, -1}, {3, -1, -1}};
  VertexClasses classes(corners.size());
  classes.split_by(corners, &ObjCorner::v);
  EXPECT_THAT(classes.vertex_of_corner(), ElementsAre(0, 1, 0, 2, 1));
  EXPECT_EQ(classes.count(), 3U);
}

TEST(VertexClasses, AnAbsentIndexIsAValueOfItsOwn) {
  const std::vector<ObjCorner> corners{{0, 0, -1}, {0, -1, -1}, {0, 0, -1}};
  VertexClasses classes(corners.size());
  classes.split_by(corners, &ObjCorner::v);
  classes.split_by(corners, &ObjCorner::vt);
  EXPECT_THAT(classes.vertex_of_corner(), ElementsAre(0, 1, 0));
  classes.split_by(corners, &ObjCorner::vn);  // absent everywhere: splits nothing
  EXPECT_EQ(classes.count(), 2U);
}

TEST(VertexClasses, AgreeWithTuplesInAMap) {
  std::mt19937 random(5);
  for (int round = 0; round < 50; ++round) {
    const std::size_t corner_count = 1 + random() % 60;
    VertexClasses classes(corner_count);
    std::vector<std::vector<std::int32_t>> tuples(corner_count);
    for (int file = 0; file < 4; ++file) {
      std::vector<ObjCorner> corners(corner_count);
      for (std::size_t i = 0; i < corner_count; ++i) {
        corners[i].vn = static_cast<std::int32_t>(random() % 4) - 1;
        tuples[i].push_back(corners[i].vn);
      }
      classes.split_by(corners, &ObjCorner::vn);
    }
    std::map<std::vector<std::int32_t>, std::uint32_t> numbers;
    for (std::size_t i = 0; i < corner_count; ++i) {
      const auto number = numbers.try_emplace(tuples[i], numbers.size()).first->second;
      ASSERT_EQ(classes.vertex_of_corner()[i], number) << "corner " << i;
    }
    ASSERT_EQ(classes.count(), numbers.size());
  }
}

}  // namespace
}  // namespace tweend::assets
