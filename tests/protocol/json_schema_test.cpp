#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "protocol/type_info.hpp"
#include "tests/protocol/described.hpp"

namespace tweend::protocol {
namespace {

using std::string_literals::operator""s;

using nlohmann::json;

template <class T>
json schema(Range range = {}) {
  return json::parse(json_schema(type_of<T>(), range));
}

bool has_type(const json& value, const std::string& type) {
  if (type == "boolean") return value.is_boolean();
  if (type == "null") return value.is_null();
  if (type == "string") return value.is_string();
  if (type == "array") return value.is_array();
  if (type == "object") return value.is_object();
  if (type == "number") return value.is_number();
  // Draft 6 and later: a number without a fraction is an integer, however it is written.
  return type == "integer" && value.is_number() && std::floor(value.get<double>()) == value.get<double>();
}

/// As much of JSON Schema as ours use; a keyword that is not known here fails the test.
bool accepts(const json& schema, const json& value) {
  for (const auto& [keyword, rule] : schema.items()) {
    if (keyword == "type") {
      if (!has_type(value, rule)) return false;
    } else if (keyword == "enum") {
      if (std::find(rule.begin(), rule.end(), value) == rule.end()) return false;
    } else if (keyword == "anyOf") {
      if (std::none_of(rule.begin(), rule.end(), [&](const json& s) { return accepts(s, value); })) return false;
    } else if (keyword == "minimum") {
      if (value.is_number() && value.get<double>() < rule.get<double>()) return false;
    } else if (keyword == "exclusiveMinimum") {
      if (value.is_number() && value.get<double>() <= rule.get<double>()) return false;
    } else if (keyword == "maximum") {
      if (value.is_number() && value.get<double>() > rule.get<double>()) return false;
    } else if (keyword == "pattern") {
      if (value.is_string() && !std::regex_search(value.get<std::string>(), std::regex(rule.get<std::string>()))) return false;
    } else if (keyword == "minItems") {
      if (value.is_array() && value.size() < rule.get<std::size_t>()) return false;
    } else if (keyword == "maxItems") {
      if (value.is_array() && value.size() > rule.get<std::size_t>()) return false;
    } else if (keyword == "items") {
      if (value.is_array() && !std::all_of(value.begin(), value.end(), [&](const json& v) { return accepts(rule, v); }))
        return false;
    } else if (keyword == "required") {
      for (const json& name : rule) {
        if (value.is_object() && !value.contains(name.get<std::string>())) return false;
      }
    } else if (keyword == "properties") {
      for (const auto& [name, s] : rule.items()) {
        if (value.is_object() && value.contains(name) && !accepts(s, value[name])) return false;
      }
    } else if (keyword == "additionalProperties") {
      if (rule != false) continue;
      for (const auto& [name, ignored] : value.items()) {
        if (value.is_object() && !schema["properties"].contains(name)) return false;
      }
    } else if (keyword != "description" && keyword != "title" && keyword != "contentEncoding") {
      ADD_FAILURE() << "an unknown keyword: " << keyword;
    }
  }
  return true;
}

/// What a client may check before it sends: the schema takes a value exactly where decoding does.
template <class T, Range kRange = Range{}>
void expect_agreement(const std::vector<std::string>& more = {}) {
  std::vector<std::string> texts{"null",    "true",      "0",          "1",       "-1",        "2.5",
                                 "3.0",     "1e10",      "\"\"",       "\"x\"",   "[]",        "{}",
                                 "[0,0,0]", "[1,0,0,1]", "[1,null,2]", "[\"x\"]", "[0.5,1.5]", "{\"x\":1}"};
  texts.insert(texts.end(), more.begin(), more.end());
  const json s = json::parse(json_schema(type_of<One<T, kRange>>()));
  for (const std::string& text : texts) {
    const json whole = json::parse("{\"value\":"s + text + "}");
    EXPECT_EQ(accepts(s, whole), (read<T, kRange>(text).has_value())) << text << " by " << s.dump();
  }
}

TEST(JsonSchema, AgreesWithTheDecoderOnScalars) {
  expect_agreement<bool>();
  expect_agreement<std::int64_t>();
  expect_agreement<std::uint64_t>();
  expect_agreement<double>();
  expect_agreement<float>();
  expect_agreement<std::string>();
  expect_agreement<Colour>({"\"red\"", "\"blue\"", "\"Red\""});
  expect_agreement<Name>({"\"a.b-c_D9\"", "\".a\"", "\"-a\"", "\""s + std::string(64, 'a') + "\"",
                          "\""s + std::string(65, 'a') + "\"", "\"a b\"", "\"a/b\"", "\"caf\u00e9\""});
}

TEST(JsonSchema, AgreesWithTheDecoderOnRanges) {
  constexpr Range kUnit{.min = 0.0, .max = 1.0};
  expect_agreement<double, kPositive>();
  expect_agreement<double, kNotNegative>();
  expect_agreement<double, kUnit>({"0.5", "1.0000001", "-0.0000001"});
  expect_agreement<std::uint64_t, kPositive>();
  expect_agreement<std::uint64_t, kUnit>();
  expect_agreement<std::int64_t, kUnit>();
  expect_agreement<glm::vec3, kUnit>({"[0,0.5,1]", "[0,0.5,1.5]", "[-1,0,0]"});
  expect_agreement<std::array<double, 2>, kNotNegative>({"[0,1]", "[-1,1]"});
  expect_agreement<std::optional<double>, kPositive>();
  expect_agreement<Nullable<double>, kPositive>();
}

TEST(JsonSchema, AgreesWithTheDecoderOnArrays) {
  expect_agreement<glm::vec3>({"[1,2]", "[1,2,3,4]"});
  expect_agreement<glm::quat>({"[0,0,1]", "[0,0,0,1,0]", "[0,0,0,\"1\"]"});
  expect_agreement<std::array<double, 4>>();
  expect_agreement<std::vector<float>>();
  expect_agreement<std::vector<std::uint32_t>>({"[0,4294967295]", "[4294967296]", "[-1]", "[0.5]", "[2.0]"});
  expect_agreement<std::vector<std::string>>();
  expect_agreement<std::vector<std::int64_t>>();
  expect_agreement<std::vector<Colour>>({"[\"red\",\"pink\"]", "[\"red\",\"green\"]"});
}

TEST(JsonSchema, AgreesWithTheDecoderOnObjects) {
  expect_agreement<None>();
  expect_agreement<Part>(
      {R"({"scale":[1,2,3]})", R"({"scale":null})", R"({"colour":"red","positions":[]})", R"({"scale":[1,2,3],"size":1})"});
  expect_agreement<std::vector<Part>>({"[{},{\"colour\":\"red\"}]", "[{},{\"colour\":\"pink\"}]", "[{},null]"});
  expect_agreement<One<std::optional<double>>>({"{\"value\":1}", "{\"value\":null}"});
  expect_agreement<Default<double>>({"{\"value\":1}", "{\"value\":null}"});
  expect_agreement<Nullable<Colour>>({"\"red\"", "\"pink\""});
  expect_agreement<JsonValue>();
}

TEST(JsonSchema, SaysWhatIsRequired) {
  const json s = schema<Whole>();
  EXPECT_EQ(s["type"], "object");
  EXPECT_EQ(s["title"], "Whole");
  EXPECT_EQ(s["required"], json::parse(R"(["from","to"])"));
  EXPECT_EQ(s["additionalProperties"], false);
  EXPECT_FALSE(schema<Part>().contains("required"));
  EXPECT_FALSE(schema<Default<double>>().contains("required"));
}

TEST(JsonSchema, DescribesEveryField) {
  const json s = schema<Whole>();
  EXPECT_EQ(s["properties"]["from"]["description"], "Where it begins.");
  EXPECT_EQ(s["properties"]["transform"]["description"], "Where it stands.");
  EXPECT_EQ(s["properties"]["transform"]["properties"]["scale"]["description"], "Factors along x, y and z.");
  EXPECT_EQ(s["properties"]["parts"]["items"]["properties"]["positions"]["description"], "x, y, z of each.");
}

TEST(JsonSchema, NamesBase64AndMaps) {
  EXPECT_EQ(schema<Base64Floats>(), json::parse(R"({"type":"string","contentEncoding":"base64"})"));
  EXPECT_EQ(schema<Base64Indices>(), json::parse(R"({"type":"string","contentEncoding":"base64"})"));
  const auto map = schema<std::map<std::string, double>>();
  EXPECT_TRUE(accepts(map, json::parse(R"({"a":1,"b":2.5})")));
  EXPECT_EQ(map["additionalProperties"]["type"], "number");
}

}  // namespace
}  // namespace tweend::protocol
