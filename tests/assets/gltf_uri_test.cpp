#include "server/assets/gltf_uri.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <optional>

#include "tests/assets/sample_gltf.hpp"

namespace tweend::assets {
namespace {

using ::testing::HasSubstr;

/// What `uri` fetches in a folder `models` of an assets folder with one file in it and one beside it.
Result<std::string> fetch(const std::string& uri, std::size_t max_bytes = 100) {
  const std::map<std::string, std::string, std::less<>> files{{"models/a b.bin", "spaced"}, {"shared/x.bin", "beside"}};
  GltfUris uris(
      "models/a.gltf",
      [&](std::string_view name, std::size_t most) -> Result<std::string> {
        const auto at = files.find(name);
        if (at == files.end()) return fail(ErrorCode::NotFound, "found no " + std::string(name));
        if (at->second.size() > most) return fail(ErrorCode::Limit, "too long");
        return at->second;
      },
      max_bytes);
  const JsonDocument document = must(JsonDocument::parse(Json{{"uri", uri}}.dump(), "models/a.gltf", Limits{}));
  return uris.fetch(*document.root().find("uri"));
}

std::string refusal(const std::string& uri) {
  const auto fetched = fetch(uri);
  if (fetched) return "none";
  EXPECT_EQ(fetched.error().code, ErrorCode::BadAsset) << uri;
  EXPECT_THAT(fetched.error().message, HasSubstr("\"models/a.gltf\" /uri: ")) << uri;
  return fetched.error().message;
}

TEST(GltfUris, ReadsDataInBase64) {
  for (const std::string_view text : {"", "a", "ab", "abc", "abcd", "\xFF\x80\x01"}) {
    EXPECT_EQ(must(fetch("data:application/octet-stream;base64," + GltfBuilder::base64(text))), std::string(text));
  }
  EXPECT_EQ(must(fetch("DATA:;BASE64,YWI")), "ab");
}

TEST(GltfUris, RefusesDataThatIsNone) {
  for (const char* uri : {"data:text/plain,abc", "data:;base64", "data:;base64,a", "data:;base64,YW$=", "data:;base64,YQ=",
                          "data:;base64,YQ===", "data:;base64,Y=Q=", "data:;base64,YR=="}) {
    EXPECT_NE(refusal(uri), "none") << uri;
  }
}

TEST(GltfUris, ReadsFilesBesideTheOwn) {
  EXPECT_EQ(must(fetch("a%20b.bin")), "spaced");
  EXPECT_EQ(must(fetch("./a b.bin")), "spaced");
  EXPECT_EQ(must(fetch("../shared/x.bin")), "beside");
  EXPECT_EQ(must(fetch("..%2Fshared/x.bin")), "beside");
}

TEST(GltfUris, StaysInTheFolder) {
  for (const char* uri : {"../../x.bin", "%2E%2E/%2e%2e/x.bin", "/etc/passwd", "%2Fetc/passwd", "\\\\host\\share", "C:/x.bin",
                          "http://host/x.bin", "file:///etc/passwd", "HTTPS://host/x", "javascript:alert(1)", "x%00.bin",
                          "x%0.bin", "x%zz.bin", "missing.bin", "", "a%FF.bin"}) {
    EXPECT_NE(refusal(uri), "none") << uri;
  }
  EXPECT_THAT(refusal("http://host/x.bin"), HasSubstr("\"http://host/x.bin\""));
}

TEST(GltfUris, CountsTheBytesItReads) {
  const auto fetched = fetch("a%20b.bin", 5);
  ASSERT_FALSE(fetched);
  EXPECT_EQ(fetched.error().code, ErrorCode::Limit);
}

}  // namespace
}  // namespace tweend::assets
