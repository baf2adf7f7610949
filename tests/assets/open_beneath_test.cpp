#include "server/assets/open_beneath.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>

#include "tests/assets/temp_folder.hpp"

namespace tweend::assets {
namespace {

using Open = Opened (*)(int, const std::string&, int);

/// Both ways of opening, over a folder `root` beside a file and a folder that must stay out of reach.
class OpenBeneath : public testing::TestWithParam<Open> {
 protected:
  OpenBeneath() {
    folder_.write("secret", "secret");
    folder_.write("outside/secret", "secret");
    folder_.write("root/sub/deep/file", "content");
    root_ = Descriptor(::open(folder_.path("root").c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  }
  [[nodiscard]] Opened open(const std::string& path, int flags = O_RDONLY) const {
    return GetParam()(root_.get(), path, flags);
  }

  TempFolder folder_;
  Descriptor root_;
};

TEST_P(OpenBeneath, OpensFilesAndFoldersBeneath) {
  const Opened file = open("sub/deep/file");
  ASSERT_TRUE(file.descriptor.is_open());
  char text[8] = {};
  EXPECT_EQ(::read(file.descriptor.get(), text, sizeof(text)), 7);
  EXPECT_STREQ(text, "content");
  EXPECT_TRUE(open(".", O_RDONLY | O_DIRECTORY).descriptor.is_open());
  EXPECT_TRUE(open("sub/deep", O_PATH).descriptor.is_open());
}

TEST_P(OpenBeneath, SaysWhatIsMissing) {
  EXPECT_EQ(open("nothing").error, ENOENT);
  EXPECT_EQ(open("sub/nothing/file").error, ENOENT);
  EXPECT_EQ(open("sub/deep/file/more").error, ENOTDIR);
}

TEST_P(OpenBeneath, DescriptorsAreNotInherited) {
  const Opened file = open("sub/deep/file");
  EXPECT_NE(::fcntl(file.descriptor.get(), F_GETFD) & FD_CLOEXEC, 0);
}

TEST_P(OpenBeneath, NeverLeaves) {
  folder_.link("root/absolute", "/etc/passwd");
  folder_.link("root/up", "../secret");
  folder_.link("root/folder", folder_.path("outside"));
  folder_.link("root/sub/twice", "../../outside");
  folder_.link("root/magic", "/proc/self/root");
  for (const char* path :
       {"..", "../secret", "sub/../../secret", "absolute", "up", "folder/secret", "sub/twice/secret", "magic/etc/passwd"}) {
    const Opened opened = open(path);
    EXPECT_FALSE(opened.descriptor.is_open()) << path;
    EXPECT_NE(opened.error, 0) << path;
  }
}

TEST_P(OpenBeneath, LinkLoopsEnd) {
  folder_.link("root/a", "b");
  folder_.link("root/b", "a");
  EXPECT_EQ(open("a").error, ELOOP);
}

INSTANTIATE_TEST_SUITE_P(Kernel, OpenBeneath, testing::Values(&open_beneath));
INSTANTIATE_TEST_SUITE_P(BySteps, OpenBeneath, testing::Values(&open_beneath_by_steps));

TEST(OpenBeneathBySteps, FollowsNoLinkAtAll) {
  TempFolder folder;
  folder.write("real/file", "content");
  folder.link("alias", "real");
  folder.link("file", "real/file");
  const Descriptor root(::open(folder.path().c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  EXPECT_EQ(open_beneath_by_steps(root.get(), "alias/file", O_RDONLY).error, ENOTDIR);
  EXPECT_EQ(open_beneath_by_steps(root.get(), "file", O_RDONLY).error, ELOOP);
  EXPECT_EQ(open_beneath_by_steps(root.get(), "real//file", O_RDONLY).error, ENOENT);
}

TEST(Descriptor, ClosesOnceAndMoves) {
  Descriptor a(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  const int fd = a.get();
  ASSERT_TRUE(a.is_open());
  {
    const Descriptor b(std::move(a));
    EXPECT_EQ(b.get(), fd);
    EXPECT_NE(::fcntl(fd, F_GETFD), -1);
  }
  EXPECT_EQ(::fcntl(fd, F_GETFD), -1);
}

}  // namespace
}  // namespace tweend::assets
