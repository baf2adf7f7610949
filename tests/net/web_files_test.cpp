#include "server/net/web_files.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <stdexcept>

namespace tweend::net {
namespace {

namespace fs = std::filesystem;

/// A folder with a page in it, gone afterwards.
class WebFilesTest : public testing::Test {
 protected:
  WebFilesTest() {
    std::string pattern = (fs::temp_directory_path() / "tweend_web_XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("can't make a folder like " + pattern);
    folder_ = pattern;
  }
  ~WebFilesTest() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  void write(const fs::path& name, std::string_view text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream file(folder_ / name, std::ios::binary);
    file << text;
    if (!file.flush()) throw std::runtime_error("can't write " + name.string());
  }
  [[nodiscard]] WebFiles loaded() const {
    auto files = WebFiles::load(folder_);
    if (!files) throw std::runtime_error(files.error().message);
    return *files;
  }
  [[nodiscard]] std::string refusal() const {
    const auto files = WebFiles::load(folder_);
    return files ? "" : files.error().message;
  }

  fs::path folder_;
};

std::string_view header(const WebAnswer& answer, std::string_view name) {
  for (const auto& [key, value] : answer.headers) {
    if (key == name) return value;
  }
  return {};
}

TEST_F(WebFilesTest, AFolderThatIsNotThereIsRefusedByName) {
  folder_ /= "none";
  EXPECT_NE(refusal().find(folder_.string()), std::string::npos);
}

TEST_F(WebFilesTest, AFolderWithoutIndexIsNoPage) {
  write("main.js", "1");
  EXPECT_NE(refusal().find("index.html"), std::string::npos);
}

TEST_F(WebFilesTest, AFilePastTheBoundIsRefusedByName) {
  write("index.html", "<p>");
  write("large.js", std::string(WebFiles::kFileBytes, ' '));
  EXPECT_EQ(refusal(), "");
  write("large.js", std::string(WebFiles::kFileBytes + 1, ' '));
  EXPECT_NE(refusal().find("large.js"), std::string::npos);
}

TEST_F(WebFilesTest, TooManyFilesAreRefused) {
  write("index.html", "<p>");
  for (std::size_t i = 1; i < WebFiles::kFiles; ++i) write(std::to_string(i) + ".js", "1");
  EXPECT_EQ(refusal(), "");
  write("one_more.js", "1");
  EXPECT_NE(refusal().find("at most 1000 files"), std::string::npos);
}

TEST_F(WebFilesTest, TheRootIsTheIndexAndOthersHaveTheirPaths) {
  write("index.html", "<p>");
  write("main.js", "run()");
  write("controls/play.js", "play()");
  const WebFiles files = loaded();
  ASSERT_NE(files.find("/"), nullptr);
  EXPECT_EQ(files.find("/"), files.find("/index.html"));
  EXPECT_EQ(files.find("/")->bytes, "<p>");
  ASSERT_NE(files.find("/controls/play.js"), nullptr);
  EXPECT_EQ(files.find("/controls/play.js")->bytes, "play()");
}

TEST_F(WebFilesTest, NothingElseIsFoundWhateverThePathSays) {
  write("index.html", "<p>");
  write("controls/play.js", "1");
  const WebFiles files = loaded();
  for (const char* path : {"", "//", "/.", "/..", "/../index.html", "/controls", "/controls/", "/controls/../index.html",
                           "index.html", "/INDEX.HTML", "/%69ndex.html", "/controls\\play.js", "/etc/passwd"}) {
    EXPECT_EQ(files.find(path), nullptr) << path;
  }
  EXPECT_EQ(files.find(std::string_view("/index.html\0", 12)), nullptr);
}

TEST_F(WebFilesTest, NoPageHasNoFiles) { EXPECT_EQ(WebFiles().find("/"), nullptr); }

TEST_F(WebFilesTest, HiddenFilesAndTypesThatNoBrowserNeedsStayOut) {
  write("index.html", "<p>");
  write(".secret.js", "1");
  write(".git/config.json", "1");
  write("CMakeLists.txt", "1");
  write("main.js~", "1");
  fs::create_directories(folder_ / "folder.js");
  const WebFiles files = loaded();
  for (const char* path : {"/.secret.js", "/.git/config.json", "/CMakeLists.txt", "/main.js~", "/folder.js"}) {
    EXPECT_EQ(files.find(path), nullptr) << path;
  }
}

TEST_F(WebFilesTest, ALinkIsReadOnceAsWhatItPointsTo) {  // the build tree's folder is a link itself
  write("page/index.html", "<p>");
  fs::create_directory_symlink("page", folder_ / "linked");
  const auto files = WebFiles::load(folder_ / "linked");
  ASSERT_TRUE(files) << files.error().message;
  EXPECT_NE(files->find("/"), nullptr);
}

TEST_F(WebFilesTest, EachExtensionHasItsType) {
  const std::pair<const char*, const char*> expected[] = {
      {"index.html", "text/html; charset=utf-8"},
      {"a.css", "text/css; charset=utf-8"},
      {"a.js", "text/javascript; charset=utf-8"},
      {"a.mjs", "text/javascript; charset=utf-8"},
      {"a.svg", "image/svg+xml"},
      {"a.png", "image/png"},
      {"a.json", "application/json"},
      {"a.ico", "image/x-icon"},
      {"a.woff2", "font/woff2"},
  };
  for (const auto& [name, type] : expected) write(name, "x");
  const WebFiles files = loaded();
  for (const auto& [name, type] : expected) {
    const WebFile* file = files.find(std::string("/") + name);
    ASSERT_NE(file, nullptr) << name;
    EXPECT_EQ(file->content_type, type) << name;
  }
}

TEST_F(WebFilesTest, TheTagIsThatOfTheContent) {
  write("index.html", "<p>");
  write("a.js", "1");
  write("b.js", "1");
  write("c.js", "2");
  const WebFiles files = loaded();
  EXPECT_EQ(files.find("/a.js")->etag, files.find("/b.js")->etag);
  EXPECT_NE(files.find("/a.js")->etag, files.find("/c.js")->etag);
  EXPECT_TRUE(files.find("/a.js")->etag.starts_with('"') && files.find("/a.js")->etag.ends_with('"'));
}

TEST_F(WebFilesTest, AnAnswerHasTheFileAndItsPolicy) {
  const WebFile file{"<p>", "text/html", "\"abc\""};
  const WebAnswer answer = answer_web(file, "");
  EXPECT_EQ(answer.status, 200U);
  EXPECT_EQ(answer.body, "<p>");
  EXPECT_EQ(answer.content_type, "text/html");
  EXPECT_EQ(header(answer, "ETag"), "\"abc\"");
  EXPECT_EQ(header(answer, "Cache-Control"), "no-cache");
  EXPECT_EQ(header(answer, "Referrer-Policy"), "no-referrer");
  const std::string_view policy = header(answer, "Content-Security-Policy");
  EXPECT_TRUE(policy.starts_with("default-src 'none';"));
  EXPECT_NE(policy.find("frame-ancestors 'none'"), std::string_view::npos);
  EXPECT_EQ(policy.find("unsafe"), std::string_view::npos);
}

TEST_F(WebFilesTest, WhoHasItIsToldSo) {
  const WebFile file{"<p>", "text/html", "\"abc\""};
  for (const char* has : {"\"abc\"", "W/\"abc\"", "\"x\", \"abc\"", "\"x\",\t\"abc\" ", "*"}) {
    const WebAnswer answer = answer_web(file, has);
    EXPECT_EQ(answer.status, 304U) << has;
    EXPECT_EQ(answer.body, "") << has;
    EXPECT_EQ(header(answer, "ETag"), "\"abc\"") << has;
  }
  for (const char* has : {"\"abcd\"", "abc", "\"x\"", ",", "\"ab\",c"}) EXPECT_EQ(answer_web(file, has).status, 200U) << has;
}

}  // namespace
}  // namespace tweend::net
