#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "protocol/type_info.hpp"
#include "tests/protocol/described.hpp"

namespace tweend::protocol {
namespace {

using std::string_literals::operator""s;

constexpr Range kUnit{.min = 0.0, .max = 1.0};

/// One JSON text of each type; what a kind takes is left out where it is tried.
const std::vector<std::string> kOneOfEach{"null", "true", "5", "\"x\"", "[1]", "{}"};

/// Refuses all of `texts`, and of one value of each type all but those in `taken`.
template <class T, Range kRange = Range{}>
void expect_refused(std::string_view expected, std::vector<std::string> texts, const std::vector<std::string>& taken) {
  for (const std::string& text : kOneOfEach) {
    if (std::find(taken.begin(), taken.end(), text) == taken.end()) texts.push_back(text);
  }
  for (const std::string& text : texts) {
    const auto result = read<T, kRange>(text);
    ASSERT_FALSE(result) << text;
    SCOPED_TRACE(text);
    expect_invalid(result.error(), "params.value", expected);
    EXPECT_NE(result.error().message.find(", found "), std::string::npos) << result.error().message;
  }
}

template <class T, Range kRange = Range{}>
void expect_read(std::string_view text, const T& expected) {
  const auto result = read<T, kRange>(text);
  ASSERT_TRUE(result) << text << ": " << result.error().message;
  EXPECT_EQ(*result, expected) << text;
}

TEST(Decode, TakesBooleans) {
  expect_read<bool>("true", true);
  expect_read<bool>("false", false);
  expect_refused<bool>("true or false", {"0", "1", "\"true\""}, {"true"});
}

TEST(Decode, TakesIntegersAlsoWrittenWithAPoint) {
  expect_read<std::int64_t>("0", 0);
  expect_read<std::int64_t>("-7", -7);
  expect_read<std::int64_t>("3.0", 3);
  expect_read<std::int64_t>("-3.0", -3);
  expect_read<std::int64_t>("2e3", 2000);
  expect_read<std::int64_t>("9007199254740993", 9007199254740993);
  expect_read<std::int64_t>("9223372036854775807", INT64_MAX);
  expect_read<std::int64_t>("-9223372036854775808", INT64_MIN);
  expect_refused<std::int64_t>("an integer",
                               {"3.5", "-0.1", "1e300", "9223372036854775808", "18446744073709551615", "18446744073709551616",
                                "-9223372036854775809", "1e19", "\"3\""},
                               {"5"});
}

TEST(Decode, TakesUnsignedIntegers) {
  expect_read<std::uint64_t>("0", 0);
  expect_read<std::uint64_t>("-0", 0);
  expect_read<std::uint64_t>("3.0", 3);
  expect_read<std::uint64_t>("18446744073709551615", UINT64_MAX);
  expect_refused<std::uint64_t>("an integer", {"-1", "-1.0", "3.5", "18446744073709551616", "-9223372036854775808", "1e20"},
                                {"5"});
}

TEST(Decode, TakesFiniteNumbers) {
  expect_read<double>("0.1", 0.1);
  expect_read<double>("-1e308", -1e308);
  expect_read<double>("5e-324", 5e-324);
  expect_read<double>("7", 7.0);
  expect_refused<double>("a finite number", {"\"0.1\"", "\"NaN\""}, {"5"});
}

TEST(Decode, TakesFloatsThatAFloatHolds) {
  expect_read<float>("0.1", 0.1F);
  expect_read<float>("16777217", 16777216.0F);
  expect_read<float>("3.4028234663852886e38", std::numeric_limits<float>::max());
  expect_refused<float>("a finite number", {"1e39", "-1e39", "1e300"}, {"5"});
}

TEST(Decode, KeepsNumbersInTheirRange) {
  expect_read<double, kNotNegative>("0", 0.0);
  expect_refused<double, kNotNegative>("of at least 0", {"-1e-9", "-5"}, {"5"});
  expect_read<double, kPositive>("1e-300", 1e-300);
  expect_refused<double, kPositive>("above 0", {"0", "-0.0", "-5"}, {"5"});
  expect_read<double, kUnit>("0", 0.0);
  expect_read<double, kUnit>("1", 1.0);
  expect_refused<double, kUnit>("from 0 to 1", {"1.0000001", "-0.0000001"}, {});
  expect_read<std::int64_t, kUnit>("1.0", 1);
  expect_refused<std::int64_t, kUnit>("an integer from 0 to 1", {"2", "-1", "2.0"}, {});
  expect_refused<std::uint64_t, kPositive>("an integer above 0", {"0"}, {"5"});
}

TEST(Decode, AFloatThatMustBePositiveIsStillSoAsAFloat) {
  const auto result = read<float, kPositive>("1e-50");  // 0 as float
  if (result) {
    EXPECT_GT(*result, 0.0F);
  } else {
    expect_invalid(result.error(), "params.value", "above 0");
  }
  expect_read<float, kPositive>("1e-40", 1e-40F);
}

TEST(Decode, AFloatMayLieOnTheEndsOfItsRangeThoughNoFloatDoesExactly) {
  constexpr Range kAngle{.min = 0.01, .max = 3.1};  // 0.01F lies just below 0.01
  expect_read<float, kAngle>("0.01", 0.01F);
  expect_read<float, kAngle>("3.1", 3.1F);
  constexpr Range kElevation{.min = -1.5707, .max = 1.5707};  // 1.5707F lies just above 1.5707
  expect_read<float, kElevation>("1.5707", 1.5707F);
  expect_read<float, kElevation>("-1.5707", -1.5707F);
  expect_refused<float, kAngle>("from 0.01 to 3.1", {"0.0099", "3.1001"}, {});
}

TEST(Decode, TakesTexts) {
  expect_read<std::string>("\"\"", "");
  expect_read<std::string>(R"("a\"\\\/\b\f\n\r\t\u00e9\ud83d\ude00")", "a\"\\/\b\f\n\r\t\u00e9\U0001F600");
  expect_refused<std::string>("a text", {}, {"\"x\""});
}

TEST(Decode, TakesNamesOfTheLettersThatCommandsMayUse) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.-";
  for (int c = 1; c < 127; ++c) {
    const char letter = static_cast<char>(c);
    if (letter == '"' || letter == '\\' || c < 0x20) continue;
    const bool good = letters.find(letter) != std::string::npos;
    EXPECT_EQ(read<Name>(std::string("\"a") + letter + "\"").has_value(), good) << letter;
    EXPECT_EQ(read<Name>(std::string("\"") + letter + "\"").has_value(), good && letter != '.') << letter;
  }
  EXPECT_EQ(read<Name>("\""s + std::string(64, 'n') + "\"")->text, std::string(64, 'n'));
  for (const std::string& bad :
       {std::string(), std::string(65, 'n'), std::string(".."), std::string("a/b"), std::string("\\u0000"),
        std::string("a\\u0000"), std::string("caf\u00e9"), std::string(1000, 'n')}) {
    const auto result = read<Name>("\""s + bad + "\"");
    ASSERT_FALSE(result) << bad;
    expect_invalid(result.error(), "params.value", "a name");
  }
  for (const std::string& text : kOneOfEach) {
    const auto result = read<Name>(text);
    EXPECT_EQ(result.has_value(), text == "\"x\"") << text;
  }
}

TEST(Decode, TakesVectorsOfThree) {
  expect_read<glm::vec3>("[1, -2.5, 3e2]", glm::vec3(1.0F, -2.5F, 300.0F));
  expect_refused<glm::vec3>("three numbers", {"[]", "[1,2]", "[1,2,3,4]"}, {});
  for (const auto& [text, path] : std::vector<std::pair<const char*, const char*>>{
           {"[null,2,3]", "params.value[0]"}, {"[1,\"2\",3]", "params.value[1]"}, {"[1,2,1e39]", "params.value[2]"}}) {
    const auto result = read<glm::vec3>(text);
    ASSERT_FALSE(result) << text;
    expect_invalid(result.error(), path, "a finite number");
  }
  const auto outside = read<glm::vec3, kUnit>("[0,1,1.5]");
  ASSERT_FALSE(outside);
  expect_invalid(outside.error(), "params.value[2]", "from 0 to 1, found 1.5");
}

TEST(Decode, NormalisesQuaternionsInTheirOrder) {
  const auto q = read<glm::quat>("[0, 0, 3, 4]");
  ASSERT_TRUE(q);
  EXPECT_EQ(*q, glm::quat(0.8F, 0.0F, 0.0F, 0.6F));  // GLM: w first
  std::mt19937 random(5);
  std::uniform_real_distribution<double> exponent(-35.0, 38.0), value(-1.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const double scale = i % 2 == 0 ? 1.0 : std::pow(10.0, std::max(-10.0, exponent(random)));
    double xyzw[4], length = 0.0;
    for (double& v : xyzw) {
      v = static_cast<double>(static_cast<float>(scale * value(random)));
      length += v * v;
    }
    length = std::sqrt(length);
    std::string text = "[";
    for (const double v : xyzw) text.append(text.size() > 1 ? "," : "").append(encode(v));
    const auto result = read<glm::quat>(text + "]");
    ASSERT_TRUE(result) << text;
    EXPECT_NEAR(static_cast<double>(result->x), xyzw[0] / length, 1e-6) << text;
    EXPECT_NEAR(static_cast<double>(result->y), xyzw[1] / length, 1e-6) << text;
    EXPECT_NEAR(static_cast<double>(result->z), xyzw[2] / length, 1e-6) << text;
    EXPECT_NEAR(static_cast<double>(result->w), xyzw[3] / length, 1e-6) << text;
  }
}

TEST(Decode, RefusesQuaternionsWithoutADirection) {
  for (const char* text : {"[0,0,0,0]", "[-0.0,0,0.0,0]"}) {
    const auto result = read<glm::quat>(text);
    ASSERT_FALSE(result) << text;
    expect_invalid(result.error(), "params.value", "not zero");
  }
  expect_refused<glm::quat>("a quaternion", {"[0,0,1]", "[0,0,0,0,1]", "{\"x\":1}"}, {});
  const auto result = read<glm::quat>("[0,0,0,\"1\"]");
  ASSERT_FALSE(result);
  expect_invalid(result.error(), "params.value[3]");
}

TEST(Decode, TakesArraysOfAFixedNumberOfNumbers) {
  expect_read<std::array<double, 4>>("[0.25, 0.1, 0.25, 1]", {0.25, 0.1, 0.25, 1.0});
  expect_refused<std::array<double, 4>>("an array of 4 numbers", {"[]", "[1,2,3]", "[1,2,3,4,5]"}, {});
  const auto text_inside = read<std::array<double, 2>>("[0,\"1\"]");
  ASSERT_FALSE(text_inside);
  expect_invalid(text_inside.error(), "params.value[1]", "a finite number");
  const auto negative = read<std::array<double, 2>, kNotNegative>("[-1,1]");
  ASSERT_FALSE(negative);
  expect_invalid(negative.error(), "params.value[0]", "of at least 0, found -1");
}

TEST(Decode, TakesListsOfFloats) {
  expect_read<std::vector<float>>("[]", {});
  expect_read<std::vector<float>>("[1, 0.1, -2e10]", {1.0F, 0.1F, -2e10F});
  expect_refused<std::vector<float>>("an array of numbers", {"\"AAAA\""}, {"[1]"});
  for (const char* bad : {"null", "\"1\"", "1e39", "[1]", "true"}) {
    const auto result = read<std::vector<float>>("[0,1,2,3,4,5,6,7,8,9,10,11,"s + bad + ",13]");
    ASSERT_FALSE(result) << bad;
    expect_invalid(result.error(), "params.value[12]", "a finite number");
  }
}

TEST(Decode, TakesListsOfIndices) {
  expect_read<std::vector<std::uint32_t>>("[]", {});
  expect_read<std::vector<std::uint32_t>>("[0, 2, 4294967295]", {0, 2, 4294967295U});
  expect_refused<std::vector<std::uint32_t>>("an array of indices", {}, {"[1]"});
  for (const char* bad : {"-1", "4294967296", "0.5", "null", "\"0\"", "1e10", "18446744073709551616"}) {
    const auto result = read<std::vector<std::uint32_t>>("[0,1,"s + bad + "]");
    ASSERT_FALSE(result) << bad;
    expect_invalid(result.error(), "params.value[2]", "whole number");
  }
}

TEST(Decode, TakesIndicesWrittenWithAPointLikeAllIntegers) {
  expect_read<std::vector<std::uint32_t>>("[0.0, 1.0, 2e0]", {0, 1, 2});
}

TEST(Decode, TakesBase64OfLittleEndianValues) {
  // 00 00 80 3F = 1.0F, 00 00 00 C0 = -2.0F
  const auto floats = read<Base64Floats>("\"AACAPwAAAMA=\"");
  ASSERT_TRUE(floats) << floats.error().message;
  EXPECT_EQ(floats->values, (std::vector<float>{1.0F, -2.0F}));
  // 01 02 03 04
  const auto indices = read<Base64Indices>("\"AQIDBA==\"");
  ASSERT_TRUE(indices);
  EXPECT_EQ(indices->values, (std::vector<std::uint32_t>{0x04030201}));
  EXPECT_TRUE(read<Base64Floats>("\"\"")->values.empty());
  for (const std::string& text : kOneOfEach) {
    if (text == "\"x\"") continue;
    ASSERT_FALSE(read<Base64Floats>(text)) << text;
    expect_invalid(read<Base64Floats>(text).error(), "params.value", "base64");
  }
  expect_invalid(read<Base64Floats>("\"AQID\"").error(), "params.value", "a multiple of 4 bytes, found 3");
  expect_invalid(read<Base64Floats>("\"AQI\"").error(), "params.value", "multiple of 4 characters");
  expect_invalid(read<Base64Indices>("\"AQ*DBA==\"").error(), "params.value", "position 2");
}

TEST(Decode, TakesTheNamesOfAnEnum) {
  expect_read<Colour>("\"red\"", Colour::Red);
  expect_read<Colour>("\"blue\"", Colour::Blue);
  expect_refused<Colour>("one of red, green, blue", {"\"\"", "\"Red\"", "\"re\"", "\"redd\"", "0", "2"}, {});
  EXPECT_NE(read<Colour>("\"pink\"").error().message.find("found \"pink\""), std::string::npos);
}

TEST(Decode, TakesListsOfWhatMayBeListed) {
  expect_read<std::vector<std::string>>("[\"a\",\"\"]", {"a", ""});
  expect_read<std::vector<std::int64_t>>("[3,1.0,-2]", {3, 1, -2});
  expect_read<std::vector<Colour>>("[\"green\",\"green\"]", {Colour::Green, Colour::Green});
  expect_read<std::vector<Colour>>("[]", {});
  expect_refused<std::vector<std::string>>("an array", {}, {"[1]"});
  expect_invalid(read<std::vector<std::string>>("[\"a\",null]").error(), "params.value[1]", "a text, found null");
  expect_invalid(read<std::vector<std::int64_t>>("[0,1,2.5]").error(), "params.value[2]", "found 2.5");
  expect_invalid(read<std::vector<Colour>>("[\"pink\"]").error(), "params.value[0]", "found \"pink\"");
}

TEST(Decode, TellsLeftOutFromGiven) {
  using Optional = std::optional<double>;
  EXPECT_EQ(decode<One<Optional>>(parsed("{}"))->value, std::nullopt);
  expect_read<Optional>("2", 2.0);
  expect_invalid(read<Optional>("null").error(), "params.value", "found null");
}

TEST(Decode, TellsLeftOutFromNullFromGiven) {
  using Takes = Nullable<Colour>;
  EXPECT_FALSE(decode<One<Takes>>(parsed("{}"))->value.has_value());
  const auto null = read<Takes>("null");
  ASSERT_TRUE(null);
  ASSERT_TRUE(null->has_value());
  EXPECT_FALSE((*null)->has_value());
  const auto given = read<Takes>("\"blue\"");
  ASSERT_TRUE(given);
  EXPECT_EQ(**given, Colour::Blue);
  expect_invalid(read<Takes>("false").error(), "params.value", "one of red, green, blue, found false");
}

TEST(Decode, RangesHoldInsideOptionals) {
  expect_invalid(read<std::optional<double>, kPositive>("0").error(), "params.value", "above 0, found 0");
  expect_invalid(read<Nullable<double>, kPositive>("-1").error(), "params.value", "above 0, found -1");
  EXPECT_TRUE((read<Nullable<double>, kPositive>("null")));
}

TEST(Decode, MissesRequiredParametersOnly) {
  const auto missing = decode<One<double>>(parsed("{}"));
  ASSERT_FALSE(missing);
  expect_invalid(missing.error(), "params.value", "The value.");
  EXPECT_EQ(decode<Default<double>>(parsed("{}"))->value, 0.0);
  EXPECT_EQ(decode<Default<double>>(parsed("{\"value\":3}"))->value, 3.0);
  expect_invalid(decode<Default<double>>(parsed("{\"value\":null}")).error(), "params.value", "found null");
}

TEST(Decode, NamesUnknownParameters) {
  expect_invalid(decode<One<double>>(parsed("{\"value\":1,\"Value\":2}")).error(), "params.Value", "one of value");
  expect_invalid(decode<One<double>>(parsed("{\"valeu\":1}")).error(), "params.valeu", "one of value");
  expect_invalid(decode<None>(parsed("{\"x\":1}")).error(), "params.x", "no parameters");
  expect_invalid(decode<None>(parsed("{\"\":1}")).error(), "params.", "no parameters");
  EXPECT_TRUE(decode<None>(parsed("{}")));
}

TEST(Decode, NamesThePathOfWhatIsWrongInside) {
  const auto path_of = [](const std::string& rest) {
    const auto result = decode<Whole>(parsed("{\"from\":0,\"to\":1" + rest + "}"));
    return result ? std::string("none") : result.error().path;
  };
  EXPECT_EQ(path_of(""), "none");
  EXPECT_EQ(path_of(R"(,"transform":{"scale":[1,1,"1"]})"), "params.transform.scale[2]");
  EXPECT_EQ(path_of(R"(,"transform":{"scale":[1,1]})"), "params.transform.scale");
  EXPECT_EQ(path_of(R"(,"transform":{"positions":[0,0,0,0,0,0,0,0,0,0,0,0,null]})"), "params.transform.positions[12]");
  EXPECT_EQ(path_of(R"(,"transform":{"size":1})"), "params.transform.size");
  EXPECT_EQ(path_of(R"(,"transform":null)"), "params.transform");
  EXPECT_EQ(path_of(R"(,"transform":[])"), "params.transform");
  EXPECT_EQ(path_of(R"(,"parts":[{},{"colour":7}])"), "params.parts[1].colour");
  EXPECT_EQ(path_of(R"(,"parts":[{},{},5])"), "params.parts[2]");
}

TEST(Decode, AppliesRulesAcrossFieldsAtTheirPath) {
  expect_invalid(decode<Whole>(parsed("{\"from\":2,\"to\":1}")).error(), "params.to", "from before to");
  expect_invalid(decode<Whole>(parsed("{\"from\":1,\"to\":2,\"parts\":[]}")).error(), "params", "a part");
  expect_invalid(read<Whole>("{\"from\":1,\"to\":1}").error(), "params.value.to");
}

TEST(Decode, StartsItsPathsAsAsked) {
  const auto result = decode<One<double>>(parsed("{\"value\":\"x\"}"), "params.edits[3].params");
  ASSERT_FALSE(result);
  expect_invalid(result.error(), "params.edits[3].params.value");
}

TEST(Decode, WantsAnObject) {
  for (const char* text : {"null", "[]", "5", "\"x\"", "true"}) {
    const auto result = decode<None>(parsed(text));
    ASSERT_FALSE(result) << text;
    expect_invalid(result.error(), "params", "an object");
  }
}

TEST(Decode, KeepsObjectsForLater) {
  JsonValue later;
  {
    const auto result = read<JsonValue>(R"({"value":{"from":1,"to":2}})");
    ASSERT_TRUE(result);
    later = *result;
  }
  const auto inner = decode<One<JsonValue>>(later);  // the whole document is gone but for this part
  ASSERT_TRUE(inner);
  EXPECT_EQ(decode<Whole>(inner->value)->to, 2.0);
  expect_refused<JsonValue>("an object", {}, {"{}"});
}

TEST(Decode, QuotesShortTextsOnly) {
  const std::string text(5000, 'z');
  const auto result = read<double>("\""s + text + "\"");
  ASSERT_FALSE(result);
  EXPECT_LT(result.error().message.size(), 200U);
  EXPECT_NE(result.error().message.find("a text of 5000 bytes"), std::string::npos) << result.error().message;
}

struct Point {
  static constexpr std::string_view kName = "Point";
  std::optional<glm::vec3> at;
  static void describe(FieldList<Point>& f) { f.add<&Point::at>("at", "Where."); }
};

TEST(Decode, TakesObjectsWithNamesOfTheClientsChoice) {
  const auto points = read<Entries<Point>>(R"({"b":{"at":[1,2,3]},"a b":{}})");
  ASSERT_TRUE(points) << points.error().message;
  ASSERT_EQ(points->list.size(), 2U);
  EXPECT_EQ(points->list[0].first, "a b") << "in the order of their names";
  EXPECT_FALSE(points->list[0].second.at);
  EXPECT_EQ(points->list[1].second.at, glm::vec3(1, 2, 3));
}

TEST(Decode, NamesThePathWithinSuchAnObject) {
  const auto refused_at = [](std::string_view text) {
    const auto points = read<Entries<Point>>(text);
    return points ? std::string() : points.error().path;
  };
  EXPECT_EQ(refused_at("[]"), "params.value");
  EXPECT_EQ(refused_at(R"({"arm":5})"), "params.value.arm");
  EXPECT_EQ(refused_at(R"({"arm":{"twist":1}})"), "params.value.arm.twist");
  EXPECT_EQ(refused_at(R"({"arm":{"at":[1,2]}})"), "params.value.arm.at");
}

}  // namespace
}  // namespace tweend::protocol
