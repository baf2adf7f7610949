#include "server/assets/asset_root.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "tests/assets/must.hpp"
#include "tests/assets/temp_folder.hpp"

using namespace std::literals;
using testing::HasSubstr;

namespace tweend::assets {
namespace {

constexpr std::size_t kPlenty = 1'000'000;

/// A root beside a file that must stay out of reach.
class AssetRootTest : public testing::Test {
 protected:
  AssetRootTest() {
    folder_.write("secret", "secret");
    folder_.make_folder("root");
  }
  [[nodiscard]] AssetRoot open() const { return must(AssetRoot::open(folder_.path("root").string())); }
  [[nodiscard]] Result<std::string> read(std::string_view name, std::size_t max_bytes = kPlenty) const {
    return open().read_file(name, max_bytes);
  }
  [[nodiscard]] ErrorCode code_of(std::string_view name) const {
    const Result<std::string> text = read(name);
    return text ? ErrorCode::Internal : text.error().code;
  }

  TempFolder folder_;
};

TEST_F(AssetRootTest, OpeningNamesTheFolderAndTheReason) {
  const std::string missing = folder_.path("missing").string();
  const auto root = AssetRoot::open(missing);
  ASSERT_FALSE(root);
  EXPECT_THAT(root.error().message, HasSubstr(missing));
  EXPECT_THAT(root.error().message, HasSubstr("No such file or directory"));
  const auto file = AssetRoot::open(folder_.path("secret").string());
  ASSERT_FALSE(file);
  EXPECT_THAT(file.error().message, HasSubstr("Not a directory"));
}

TEST_F(AssetRootTest, ReadsAFileWhole) {
  const std::string text = "a\0b\r\n"s + std::string(700'000, 'x');
  folder_.write("root/sub/file.bin", text);
  EXPECT_EQ(must(read("sub/file.bin")), text);
}

TEST_F(AssetRootTest, ReadsUpToTheLimitAndNoFurther) {
  folder_.write("root/empty", "");
  folder_.write("root/five", "12345");
  EXPECT_EQ(must(read("empty", 0)), "");
  EXPECT_EQ(must(read("five", 5)), "12345");
  const auto over = read("five", 4);
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().code, ErrorCode::Limit);
  EXPECT_THAT(over.error().message, HasSubstr("at most 4 bytes"));
}

TEST_F(AssetRootTest, ReadsFilesThatDoNotKnowTheirLength) {
  const AssetRoot proc = must(AssetRoot::open("/proc/self"));
  EXPECT_THAT(must(proc.read_file("status", kPlenty)), HasSubstr("Name:"));  // says 0 bytes, holds some
  const auto over = proc.read_file("status", 10);
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().code, ErrorCode::Limit);
}

TEST_F(AssetRootTest, WhatIsNotThereIsNotFound) {
  folder_.write("root/file", "x");
  EXPECT_EQ(code_of("nothing"), ErrorCode::NotFound);
  EXPECT_EQ(code_of("file/more"), ErrorCode::NotFound);
  EXPECT_EQ(code_of(std::string(300, 'x')), ErrorCode::NotFound);
}

TEST_F(AssetRootTest, NamesThatLeaveAreNotFound) {
  folder_.write("root/sub/file", "x");
  for (const auto name : {""sv, ".."sv, "../secret"sv, "sub/../sub/file"sv, "sub/../../secret"sv, "/etc/passwd"sv,
                          "./sub/file"sv, "sub//file"sv, "sub/file\0"sv, "..\\secret"sv}) {
    EXPECT_EQ(code_of(name), ErrorCode::NotFound) << name;
  }
}

TEST_F(AssetRootTest, LinksThatLeaveAreNotFound) {
  folder_.link("root/passwd", "/etc/passwd");
  folder_.link("root/up", "../secret");
  folder_.link("root/folder", "..");
  folder_.link("root/chain", "up");
  folder_.link("root/loop", "loop");
  for (const char* name : {"passwd", "up", "folder/secret", "chain", "loop"}) {
    EXPECT_EQ(code_of(name), ErrorCode::NotFound) << name;
    EXPECT_FALSE(open().find(name)) << name;
  }
}

TEST_F(AssetRootTest, LinksThatStayAreFollowed) {
  folder_.write("root/real/file", "content");
  folder_.link("root/alias", "real");
  folder_.link("root/real/twin", "../alias/file");
  EXPECT_EQ(must(read("alias/file")), "content");
  EXPECT_EQ(must(read("real/twin")), "content");
}

TEST_F(AssetRootTest, TheFolderStaysOpenUnderAnotherName) {
  folder_.write("root/file", "content");
  const AssetRoot root = open();
  std::filesystem::rename(folder_.path("root"), folder_.path("moved"));
  folder_.write("root/file", "another");
  EXPECT_EQ(must(root.read_file("file", kPlenty)), "content");
}

TEST_F(AssetRootTest, OnlyRegularFilesAreRead) {
  folder_.make_folder("root/folder");
  ASSERT_EQ(::mkfifo(folder_.path("root/pipe").c_str(), 0600), 0);
  // A name of any length, which bind() does not take.
  ASSERT_EQ(::mknod(folder_.path("root/socket").c_str(), S_IFSOCK | 0600, 0), 0);
  for (const char* name : {"folder", "pipe", "socket"}) EXPECT_EQ(code_of(name), ErrorCode::BadAsset) << name;
  const auto zero = must(AssetRoot::open("/dev")).read_file("zero", kPlenty);
  ASSERT_FALSE(zero);
  EXPECT_EQ(zero.error().code, ErrorCode::BadAsset);
}

TEST_F(AssetRootTest, FindsFilesAndFolders) {
  folder_.write("root/sub/file", "12345");
  const AssetEntry file = must(open().find("sub/file"));
  EXPECT_FALSE(file.directory);
  EXPECT_EQ(file.bytes, 5U);
  EXPECT_TRUE(must(open().find("sub")).directory);
}

TEST_F(AssetRootTest, ListsFilesAndFoldersByName) {
  folder_.write("root/b", "12");
  folder_.write("root/a/x", "");
  folder_.write("root/.hidden", "");
  folder_.link("root/inside", "b");
  folder_.link("root/alias", "a");
  folder_.link("root/outside", "../secret");
  folder_.link("root/dangling", "nothing");
  ASSERT_EQ(::mkfifo(folder_.path("root/pipe").c_str(), 0600), 0);
  std::string seen;
  for (const AssetEntry& e : must(open().list_folder(""))) {
    seen += fmt::format("{}{}{} ", e.name, e.directory ? "/" : fmt::format("={}", e.bytes), e.link ? "@" : "");
  }
  EXPECT_EQ(seen, ".hidden=0 a/ alias/@ b=2 inside=2@ ");
  EXPECT_EQ(must(open().list_folder("alias")).size(), 1U);
}

TEST_F(AssetRootTest, ListsOnlyFoldersThatAreThere) {
  folder_.write("root/file", "x");
  for (const char* name : {"nothing", "file", "..", "/", "."}) {
    const auto entries = open().list_folder(name);
    ASSERT_FALSE(entries) << name;
    EXPECT_EQ(entries.error().code, ErrorCode::NotFound) << name;
  }
}

TEST_F(AssetRootTest, LeavesNoDescriptorOpen) {
  folder_.write("root/file", "x");
  const auto open_descriptors = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
  };
  const AssetRoot root = open();
  const auto before = open_descriptors();
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(root.list_folder(""));
    EXPECT_TRUE(root.read_file("file", kPlenty));
    EXPECT_FALSE(root.read_file("nothing", kPlenty));
    EXPECT_FALSE(root.list_folder("file"));
  }
  EXPECT_EQ(open_descriptors(), before);
}

}  // namespace
}  // namespace tweend::assets
