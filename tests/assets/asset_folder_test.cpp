#include "server/assets/asset_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

namespace tweend::assets {
namespace {

AssetEntry file(std::string name, std::uint64_t bytes = 1) { return {std::move(name), false, bytes, false}; }

SequenceFile member(std::string name, std::string prefix, std::int64_t frame) {
  return {std::move(name), std::move(prefix), frame, 1};
}

TEST(AssetFolder, SortsEntriesByWhatTheyAre) {
  const AssetFolder folder = sort_entries("x", {file(".hidden_1.obj"),
                                                file("._a_1.obj"),
                                                file("a_1.obj", 7),
                                                file("a\\b.obj"),
                                                file("b.OBJ"),
                                                file("c.glb"),
                                                file("caf\xE9.obj"),
                                                {"sub", true, 0, false},
                                                {".git", true, 0, false},
                                                {"d.obj", true, 0, false}});
  EXPECT_THAT(folder.members, ElementsAre(Field(&SequenceFile::name, "x/a_1.obj")));
  EXPECT_EQ(folder.members[0].prefix, "a");
  EXPECT_EQ(folder.members[0].frame, 1);
  EXPECT_EQ(folder.members[0].bytes, 7U);
  EXPECT_THAT(folder.objs, ElementsAre(Field(&AssetEntry::name, "b.OBJ")));
  EXPECT_THAT(folder.subfolders, ElementsAre(Field(&AssetEntry::name, "sub"), Field(&AssetEntry::name, "d.obj")));
}

TEST(AssetFolder, BytesAddUpWithoutWrapping) {
  std::vector<SequenceFile> members{member("a_1.obj", "a", 1), member("a_2.obj", "a", 2)};
  EXPECT_EQ(total_bytes(members), 2U);
  members[0].bytes = ~std::uint64_t{0};
  EXPECT_EQ(total_bytes(members), ~std::uint64_t{0});
}

TEST(AssetFolder, SequencesAreOrderedByNumberNotByName) {
  const auto ordered = order_sequence({member("a_10.obj", "a", 10), member("a_5.obj", "a", 5), member("a_007.obj", "a", 7)});
  ASSERT_TRUE(ordered);
  EXPECT_THAT(*ordered,
              ElementsAre(Field(&SequenceFile::frame, 5), Field(&SequenceFile::frame, 7), Field(&SequenceFile::frame, 10)));
}

TEST(AssetFolder, RefusesTwoPrefixes) {
  const auto ordered = order_sequence({member("x/a_1.obj", "a", 1), member("x/b_2.obj", "b", 2)});
  ASSERT_FALSE(ordered);
  EXPECT_EQ(ordered.error().code, ErrorCode::BadAsset);
  EXPECT_THAT(ordered.error().message, HasSubstr("\"x/a_1.obj\" and \"x/b_2.obj\""));
}

TEST(AssetFolder, RefusesTwoFilesOfOneFrame) {
  const auto ordered = order_sequence({member("x/a_1.obj", "a", 1), member("x/a_01.obj", "a", 1)});
  ASSERT_FALSE(ordered);
  EXPECT_EQ(ordered.error().code, ErrorCode::BadAsset);
  EXPECT_THAT(ordered.error().message, HasSubstr("one file for frame 1, found \"x/a_01.obj\" and \"x/a_1.obj\""));
}

}  // namespace
}  // namespace tweend::assets
