#include "server/assets/gltf_container.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/assets/sample_gltf.hpp"

namespace tweend::assets {
namespace {

using ::testing::HasSubstr;

std::string chunk(std::string_view type, std::string_view content) {
  return GltfBuilder::u32(content.size()) + std::string(type) + std::string(content);
}
std::string glb(std::string_view chunks) {
  return "glTF" + GltfBuilder::u32(2) + GltfBuilder::u32(12 + chunks.size()) + std::string(chunks);
}
const std::string kJson = chunk("JSON", "{}  ");
const std::string kBin = chunk(std::string_view("BIN\0", 4), "1234");

std::string refusal(const std::string& bytes) {
  const auto container = open_gltf_container(bytes, "a.glb");
  if (container) return "none";
  EXPECT_EQ(container.error().code, ErrorCode::BadAsset);
  EXPECT_THAT(container.error().message, HasSubstr("\"a.glb\" at byte "));
  return container.error().message;
}

TEST(GltfContainer, TakesAnythingElseForJson) {
  EXPECT_EQ(must(open_gltf_container("{}", "a.gltf")).json, "{}");
  EXPECT_FALSE(must(open_gltf_container("{}", "a.gltf")).bin);
}

TEST(GltfContainer, FindsItsChunks) {
  const std::string whole = glb(kJson + kBin + chunk("XYZW", "abcd"));
  const GltfContainer container = must(open_gltf_container(whole, "a.glb"));
  EXPECT_EQ(container.json, "{}  ");
  EXPECT_EQ(container.bin, "1234");
  const std::string bare = glb(kJson);
  EXPECT_FALSE(must(open_gltf_container(bare, "a.glb")).bin);
}

TEST(GltfContainer, RefusesAFileThatIsCutAnywhere) {
  const std::string whole = glb(kJson + kBin);
  for (std::size_t size = 4; size < whole.size(); ++size) EXPECT_NE(refusal(whole.substr(0, size)), "none") << size;
  EXPECT_THAT(refusal(whole.substr(0, whole.size() - 1)), HasSubstr("cut short"));
  EXPECT_THAT(refusal(whole + "more"), HasSubstr("expected a file of"));
}

TEST(GltfContainer, RefusesHeadersThatAreNone) {
  std::string version = glb(kJson);
  version[4] = 1;
  EXPECT_THAT(refusal(version), HasSubstr("expected version 2"));
  EXPECT_THAT(refusal(glb("")), HasSubstr("found the end of the file"));
  EXPECT_THAT(refusal(glb("JSO")), HasSubstr("a chunk's header of 8 bytes, found 3"));
  EXPECT_THAT(refusal(glb(chunk("JSON", "{} "))), HasSubstr("multiple of 4"));
  EXPECT_THAT(refusal(glb(GltfBuilder::u32(0xFFFFFFFC) + "JSON{}  ")), HasSubstr("found one of 4294967292"));
}

TEST(GltfContainer, RefusesChunksThatAreOutOfPlace) {
  EXPECT_THAT(refusal(glb(kBin + kJson)), HasSubstr("expected a JSON chunk first"));
  EXPECT_THAT(refusal(glb(kJson + kJson)), HasSubstr("found another"));
  EXPECT_THAT(refusal(glb(kJson + kBin + kBin)), HasSubstr("at place 3"));
  EXPECT_THAT(refusal(glb(kJson + chunk("XYZW", "abcd") + kBin)), HasSubstr("at place 3"));
}

}  // namespace
}  // namespace tweend::assets
