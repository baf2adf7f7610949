#include "server/assets/new_asset_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include "server/assets/asset_root.hpp"
#include "tests/assets/must.hpp"
#include "tests/assets/temp_folder.hpp"

namespace tweend::assets {
namespace {

namespace fs = std::filesystem;

std::span<const std::byte> bytes(std::string_view text) { return std::as_bytes(std::span(text)); }

std::set<std::string> content(const TempFolder& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path())) {
    names.insert(entry.path().lexically_relative(folder.path()).string());
  }
  return names;
}

AssetRoot root_of(const TempFolder& folder) { return must(AssetRoot::open(folder.path().string())); }

TEST(NewAssetFile, RefusesNamesThatLeaveAreTakenOrHaveNoFolder) {
  const TempFolder folder;
  folder.write("file", "old");
  folder.link("link", "/nowhere/at/all");
  const AssetRoot root = root_of(folder);
  const auto code = [](const auto& result) { return result ? ErrorCode::Internal : result.error().code; };
  for (const char* name : {"../x", "", "none/x", "file/x"}) {
    EXPECT_EQ(code(root.new_file(name)), ErrorCode::NotFound) << name;
    EXPECT_EQ(code(root.new_folder(name)), ErrorCode::NotFound) << name;
  }
  for (const char* name : {"file", "link"}) {
    EXPECT_EQ(code(root.new_file(name)), ErrorCode::Conflict) << name;
    EXPECT_EQ(code(root.new_folder(name)), ErrorCode::Conflict) << name;
  }
  EXPECT_EQ(content(folder), (std::set<std::string>{"file", "link"}));
}

TEST(NewAssetFile, IsThereWholeOnceItIsCommitted) {
  const TempFolder folder;
  folder.make_folder("films");
  const AssetRoot root = root_of(folder);
  const auto file = must(root.new_file("films/a.mp4"));
  ASSERT_TRUE(file->write_at(0, bytes("....world")));
  ASSERT_TRUE(file->write_at(0, bytes("big ")));
  ASSERT_TRUE(file->write_at(9, bytes("!")));
  EXPECT_FALSE(fs::exists(folder.path() / "films/a.mp4"));
  for (const std::string& name : content(folder)) EXPECT_TRUE(name == "films" || name.starts_with("films/.")) << name;
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(must(root.read_file("films/a.mp4", 100)), "big world!");
  EXPECT_EQ(content(folder), (std::set<std::string>{"films", "films/a.mp4"}));
}

TEST(NewAssetFile, LetGoOfLeavesNothing) {
  const TempFolder folder;
  const AssetRoot root = root_of(folder);
  {
    const auto file = must(root.new_file("a"));
    ASSERT_TRUE(file->write_at(0, bytes("x")));
    const auto made = must(root.new_folder("b"));
    ASSERT_TRUE(made->add("1", bytes("x")));
  }
  EXPECT_TRUE(content(folder).empty());
}

TEST(NewAssetFile, NeverReplacesWhatTookItsNameMeanwhile) {
  const TempFolder folder;
  const AssetRoot root = root_of(folder);
  {
    const auto file = must(root.new_file("a"));
    const auto made = must(root.new_folder("b"));
    ASSERT_TRUE(made->add("1", bytes("mine")));
    folder.write("a", "theirs");
    folder.make_folder("b");
    EXPECT_EQ(file->commit().error().code, ErrorCode::Conflict);
    EXPECT_EQ(made->commit().error().code, ErrorCode::Conflict);
  }
  EXPECT_EQ(content(folder), (std::set<std::string>{"a", "b"}));
  EXPECT_EQ(must(root.read_file("a", 100)), "theirs");
}

TEST(NewAssetFolder, IsThereWithAllItsFilesOnceItIsCommitted) {
  const TempFolder folder;
  const AssetRoot root = root_of(folder);
  const auto made = must(root.new_folder("walk"));
  ASSERT_TRUE(made->add("0.png", bytes("zero")));
  ASSERT_TRUE(made->add("1.png", bytes("")));
  EXPECT_FALSE(made->add("1.png", bytes("again")));
  EXPECT_FALSE(fs::exists(folder.path() / "walk"));
  ASSERT_TRUE(made->commit());
  EXPECT_EQ(content(folder), (std::set<std::string>{"walk", "walk/0.png", "walk/1.png"}));
}

TEST(NewAssetFile, OnADiskThatIsFullLeavesNothing) {
  const TempFolder folder;
  const AssetRoot root = root_of(folder);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  {
    const auto file = must(root.new_file("a"));
    const auto written = file->write_at(0, bytes(std::string(10'000, 'x')));
    EXPECT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::Unavailable);
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_TRUE(content(folder).empty());
}

}  // namespace
}  // namespace tweend::assets
