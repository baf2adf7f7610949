#include "server/assets/asset_name.hpp"

#include <gtest/gtest.h>

using namespace std::literals;

namespace tweend::assets {
namespace {

TEST(AssetName, CleanNamesAreRelativePathsOfUtf8) {
  for (const auto name :
       {"a"sv, "barb/skeletal_000010.obj"sv, "a b.obj"sv, "..."sv, "a..b/c."sv, "Küche/椅子.obj"sv, "\xF0\x9F\x8E\xAC"sv}) {
    EXPECT_TRUE(is_clean_name(name)) << name;
  }
}

TEST(AssetName, NamesThatLeaveOrAreNoPathAreNotClean) {
  for (const auto name : {""sv, "/"sv, "/etc/passwd"sv, "."sv, ".."sv, "../a"sv, "a/.."sv, "a/../b"sv, "a/./b"sv, "a//b"sv,
                          "a/"sv, "a\\b"sv, "a\0b"sv, "a\nb"sv, "\x7F"sv}) {
    EXPECT_FALSE(is_clean_name(name)) << name;
  }
}

TEST(AssetName, BytesThatAreNotUtf8AreNotClean) {
  for (const auto name : {"\x80"sv, "\xC0\xAF"sv, "\xC3"sv, "\xC3("sv, "\xE0\x80\xAF"sv, "\xED\xA0\x80"sv, "\xF0\x80\x80\x80"sv,
                          "\xF4\x90\x80\x80"sv, "\xF5\x80\x80\x80"sv, "\xE2\x82"sv}) {
    EXPECT_FALSE(is_clean_name(name));
  }
}

TEST(AssetName, ExtensionsCompareWithoutCase) {
  EXPECT_TRUE(has_extension("a.obj", ".obj"));
  EXPECT_TRUE(has_extension("A.OBJ", ".obj"));
  EXPECT_FALSE(has_extension("a.objx", ".obj"));
  EXPECT_FALSE(has_extension("obj", ".obj"));
}

TEST(AssetName, JoinsUnderTheRootWithoutASlash) {
  EXPECT_EQ(join_name("", "a.obj"), "a.obj");
  EXPECT_EQ(join_name("x/y", "a.obj"), "x/y/a.obj");
}

TEST(AssetName, ReferencesAreFollowedFromTheirFolder) {
  EXPECT_EQ(resolve_name("", "a.png"), "a.png");
  EXPECT_EQ(resolve_name("x/y", "a b.png"), "x/y/a b.png");
  EXPECT_EQ(resolve_name("x/y", "../t/./a.png"), "x/t/a.png");
  EXPECT_EQ(resolve_name("x/y", "..\\t\\\\a.png"), "x/t/a.png");
  EXPECT_EQ(resolve_name("x/y", "../../a.png"), "a.png");
  EXPECT_EQ(resolve_name("x", "t/../../a.png"), "a.png");
  EXPECT_EQ(resolve_name("x/y", "."), "x/y");
  EXPECT_EQ(resolve_name("x", "..."), "x/...");
}

TEST(AssetName, ReferencesThatLeaveOrAreAbsoluteNameNothing) {
  for (const std::string_view reference :
       {"../../a.png"sv, "../../x/a.png"sv, "t/../../../a.png"sv, ".."sv, "/etc/passwd"sv, "\\\\host\\a.png"sv, "C:\\a.png"sv,
        "c:a.png"sv, "a\n.png"sv, "\xE9.png"sv, "a\0b"sv}) {
    EXPECT_EQ(resolve_name("x", reference), std::nullopt) << reference;
  }
  EXPECT_EQ(resolve_name("", ""), std::nullopt) << "the root is no file";
  EXPECT_EQ(resolve_name("", std::string(5'000, 'a')), std::nullopt);
}

TEST(AssetName, LongNamesAreCutBetweenCharacters) {
  EXPECT_EQ(quoted_name("a"), "\"a\"");
  std::string name(199, 'a');
  name += "éé";  // two bytes each: the cut at 200 falls inside of the first
  EXPECT_EQ(quoted_name(name), '"' + std::string(199, 'a') + "…\"");
}

}  // namespace
}  // namespace tweend::assets
