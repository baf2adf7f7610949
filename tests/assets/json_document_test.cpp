#include "server/assets/json_document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/assets/must.hpp"

namespace tweend::assets {
namespace {

using ::testing::HasSubstr;

JsonDocument parsed(std::string_view text) { return must(JsonDocument::parse(text, "a.gltf", Limits{})); }

std::string refusal(std::string_view text, const Limits& limits = {}) {
  const auto document = JsonDocument::parse(text, "a.gltf", limits);
  if (document) return "none";
  EXPECT_EQ(document.error().code, ErrorCode::BadAsset);
  return document.error().message;
}

TEST(JsonDocument, FindsItsWayByNamesAndPlaces) {
  const JsonDocument d = parsed(R"({"a":[1,{"b":"text","c":[true,null]},2.5],"d":{}})");
  const JsonNode a = *d.root().find("a");
  ASSERT_EQ(a.size(), 3U);
  EXPECT_EQ(*a.at(0).number(), 1.0);
  EXPECT_EQ(*a.at(2).number(), 2.5);
  EXPECT_EQ(*a.at(1).find("b")->text(), "text");
  EXPECT_TRUE(*a.at(1).find("c")->at(0).boolean());
  EXPECT_EQ(a.at(1).find("c")->at(1).kind(), JsonKind::Null);
  EXPECT_EQ(d.root().find("d")->size(), 0U);
  EXPECT_FALSE(d.root().find("b"));
  EXPECT_FALSE(a.find("b")) << "an array has no names";
  EXPECT_EQ(a.at(2).position(), 2U);
}

TEST(JsonDocument, PointsAtEveryValue) {
  const JsonDocument d = parsed(R"({"x":0,"accessors":[{},{"a/b~c":[[],[7]]}]})");
  const JsonNode deep = d.root().find("accessors")->at(1).find("a/b~c")->at(1).at(0);
  EXPECT_EQ(deep.pointer(), "/accessors/1/a~1b~0c/1/0");
  EXPECT_EQ(d.root().pointer(), "");
  EXPECT_EQ(deep.place(), "\"a.gltf\" /accessors/1/a~1b~0c/1/0");
  EXPECT_EQ(deep.expected("a text").message, "\"a.gltf\" /accessors/1/a~1b~0c/1/0: expected a text, found 7");
}

TEST(JsonDocument, SaysWhatIsMissingAndWhere) {
  const JsonDocument d = parsed(R"({"accessors":[{}]})");
  const auto count = d.root().find("accessors")->at(0).get("count");
  ASSERT_FALSE(count);
  EXPECT_EQ(count.error().message, "\"a.gltf\" /accessors/0: expected a member \"count\", found none");
}

TEST(JsonDocument, ChecksNumbers) {
  const JsonDocument d = parsed(R"({"n":[0,3,-1,2.5,1e300,"3",true,3.0]})");
  const JsonNode n = *d.root().find("n");
  EXPECT_EQ(*n.at(1).whole(0, 3), 3U);
  EXPECT_EQ(*n.at(7).whole(0, 3), 3U);
  EXPECT_EQ(*n.at(1).index(4, "nodes"), 3U);
  EXPECT_FALSE(n.at(1).index(3, "nodes"));
  EXPECT_FALSE(n.at(0).whole(1, 3));
  for (const std::size_t i : {2U, 3U, 4U, 5U, 6U}) EXPECT_FALSE(n.at(i).whole(0, 100)) << i;
  EXPECT_FALSE(n.floats(8)) << "1e300 is no float";
  EXPECT_FALSE(n.floats(2));
  EXPECT_THAT(n.at(4).index(3, "nodes").error().message, HasSubstr("expected the index of one of 3 nodes, found 1e+300"));
}

TEST(JsonDocument, RefusesWhatIsNoJson) {
  EXPECT_THAT(refusal(""), HasSubstr("\"a.gltf\": expected JSON"));
  EXPECT_THAT(refusal(R"({"a":1)"), HasSubstr("line 1"));
  EXPECT_THAT(refusal("{} {}"), HasSubstr("expected JSON"));
  EXPECT_THAT(refusal("[1e999]"), HasSubstr("expected JSON"));
  EXPECT_THAT(refusal("[NaN]"), HasSubstr("expected JSON"));
  EXPECT_THAT(refusal("[\"\xFF\"]"), HasSubstr("expected JSON"));
  EXPECT_THAT(refusal(std::string("{}\0", 3)), HasSubstr("NUL byte at position 2"));
}

TEST(JsonDocument, RefusesNamesThatComeTwice) {
  EXPECT_THAT(refusal(R"({"a":1,"b":2,"a":3})"), HasSubstr("\"a\" twice"));
  std::string many = "{";
  for (int i = 0; i < 100; ++i) many += "\"k" + std::to_string(i) + "\":0,";
  EXPECT_THAT(refusal(many + R"("k42":1})"), HasSubstr("\"k42\" twice"));
  EXPECT_EQ(refusal(many + R"("k100":1})"), "none");
}

TEST(JsonDocument, NestsOnlyAsDeepAsAllowed) {
  Limits limits;
  limits.json_depth = 8;
  EXPECT_EQ(refusal(std::string(8, '[') + std::string(8, ']'), limits), "none");
  EXPECT_THAT(refusal(std::string(9, '[') + std::string(9, ']'), limits), HasSubstr("nested at most 8 deep"));
  EXPECT_THAT(refusal(std::string(5'000'000, '['), limits), HasSubstr("nested at most 8 deep"));
}

TEST(JsonDocument, CountsItsValues) {
  std::string many = "[0";
  for (int i = 0; i < 4'000'000; ++i) many += ",0";
  const auto document = JsonDocument::parse(many + "]", "a.gltf", Limits{});
  ASSERT_FALSE(document);
  EXPECT_EQ(document.error().code, ErrorCode::Limit);
}

}  // namespace
}  // namespace tweend::assets
