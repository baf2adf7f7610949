#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <set>
#include <string>

#include "server/assets/asset_root.hpp"
#include "server/assets/save_beneath.hpp"
#include "tests/assets/must.hpp"
#include "tests/assets/temp_folder.hpp"

namespace tweend::assets {
namespace {

std::set<std::string> content(const TempFolder& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    names.insert(entry.path().lexically_relative(folder.path()).string());  // relative() would follow links
  }
  return names;
}

AssetRoot root_of(const TempFolder& folder) { return must(AssetRoot::open(folder.path().string())); }

ErrorCode refusal(const Status& status) {
  EXPECT_FALSE(status);
  return status ? ErrorCode::Internal : status.error().code;
}

const std::array<NewFile, 2> kFiles{NewFile{"a.txt", "one"}, NewFile{"b.txt", ""}};

TEST(SavedAssets, RefusesNamesThatLeaveOrHaveNoFolder) {
  const TempFolder folder, outside;
  folder.link("out", outside.path());
  folder.write("file", "no folder");
  const AssetRoot root = root_of(folder);
  for (const char* name : {"", "/tmp/x", "../x", "a/../x", "./x", "a//x", "out/x", "none/x", "file/x", "a\\x"}) {
    EXPECT_EQ(refusal(root.save_file(name, "x")), ErrorCode::NotFound) << name;
    EXPECT_EQ(refusal(root.save_folder(name, kFiles)), ErrorCode::NotFound) << name;
  }
  EXPECT_TRUE(content(outside).empty());
  EXPECT_EQ(content(folder), (std::set<std::string>{"out", "file"}));
}

TEST(SavedAssets, RefusesNamesThatAreTaken) {
  const TempFolder folder;
  folder.write("file", "old");
  folder.make_folder("folder");
  folder.link("link", "/nowhere/at/all");
  const auto before = content(folder);
  for (const char* name : {"file", "folder", "link"}) {
    EXPECT_EQ(refusal(root_of(folder).save_file(name, "new")), ErrorCode::Conflict) << name;
    EXPECT_EQ(refusal(root_of(folder).save_folder(name, kFiles)), ErrorCode::Conflict) << name;
  }
  EXPECT_EQ(content(folder), before);
  EXPECT_EQ(must(root_of(folder).read_file("file", 100)), "old");
}

TEST(SavedAssets, AreWholeAndAlone) {
  const TempFolder folder;
  folder.make_folder("deep/down");
  folder.link("also", "deep/down");
  const AssetRoot root = root_of(folder);
  const std::string bytes("\0\xFF\n", 3);
  EXPECT_TRUE(root.save_file("deep/down/x", bytes));
  EXPECT_TRUE(root.save_folder("also/seq", kFiles)) << "a link that stays may be followed";
  EXPECT_EQ(must(root.read_file("deep/down/x", 100)), bytes);
  EXPECT_EQ(must(root.read_file("deep/down/seq/a.txt", 100)), "one");
  EXPECT_EQ(content(folder), (std::set<std::string>{"also", "deep", "deep/down", "deep/down/x", "deep/down/seq",
                                                    "deep/down/seq/a.txt", "deep/down/seq/b.txt"}));
}

TEST(SavedAssets, LeaveNothingWhereTheDiskIsFull) {
  const TempFolder folder;
  const AssetRoot root = root_of(folder);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1'000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::array<NewFile, 2> large{NewFile{"fits", "x"}, NewFile{"large", std::string(2'000, 'x')}};
  const Status file = root.save_file("large", large[1].bytes);
  const Status files = root.save_folder("folder", large);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(refusal(file), ErrorCode::Unavailable);
  EXPECT_EQ(refusal(files), ErrorCode::Unavailable);
  EXPECT_TRUE(content(folder).empty());
}

TEST(SavedAssets, NeverReplaceAnythingEitherWay) {
  const TempFolder folder;
  folder.write("new", "new");
  folder.write("taken", "old");
  folder.write("new_folder/in", "x");
  folder.write("taken_folder/in", "old");
  const Descriptor open(::open(folder.path().c_str(), O_PATH | O_DIRECTORY));
  for (const auto rename : {&rename_new, &rename_over_placeholder}) {
    EXPECT_EQ(rename(open.get(), "new", "taken", false), EEXIST);
    EXPECT_EQ(rename(open.get(), "new_folder", "taken_folder", true), EEXIST);
    EXPECT_EQ(rename(open.get(), "none", "other", false), ENOENT);
    EXPECT_EQ(rename(open.get(), "none", "other", true), ENOENT);
    EXPECT_EQ(rename(open.get(), "new", "moved", false), 0);
    EXPECT_EQ(rename(open.get(), "moved", "new", false), 0);
    EXPECT_EQ(rename(open.get(), "new_folder", "moved", true), 0);
    EXPECT_EQ(rename(open.get(), "moved", "new_folder", true), 0);
  }
  EXPECT_EQ(content(folder),
            (std::set<std::string>{"new", "taken", "new_folder", "new_folder/in", "taken_folder", "taken_folder/in"}));
}

}  // namespace
}  // namespace tweend::assets
