#include "protocol/json_value.hpp"

#include <gtest/gtest.h>

#include <string>

#include "protocol/utf8.hpp"
#include "tests/protocol/described.hpp"

namespace tweend::protocol {
namespace {

using std::string_literals::operator""s;

ErrorCode code_of(const std::string& text, const Limits& limits = {}) {
  const auto result = JsonValue::parse(text, limits);
  EXPECT_FALSE(result) << text.substr(0, 80);
  if (result) return ErrorCode::Internal;
  EXPECT_FALSE(result.error().message.empty());
  return result.error().code;
}

bool parses(const std::string& text, const Limits& limits = {}) { return JsonValue::parse(text, limits).has_value(); }

std::string repeated(const std::string& part, std::size_t times) {
  std::string text;
  for (std::size_t i = 0; i < times; ++i) text += part;
  return text;
}

TEST(JsonValue, TakesSixtyFourLevelsAndRefusesTheNext) {
  EXPECT_TRUE(parses(repeated("[", 64) + repeated("]", 64)));
  EXPECT_TRUE(parses(repeated("{\"a\":", 64) + "1"s + repeated("}", 64)));
  EXPECT_TRUE(parses(repeated("[{\"a\":", 32) + "1"s + repeated("}]", 32)));
  EXPECT_EQ(code_of(repeated("[", 65) + repeated("]", 65)), ErrorCode::Limit);
  EXPECT_EQ(code_of(repeated("{\"a\":", 65) + "1"s + repeated("}", 65)), ErrorCode::Limit);
  EXPECT_EQ(code_of("["s + repeated("[{\"a\":", 32) + "1"s + repeated("}]", 32) + "]"), ErrorCode::Limit);
}

TEST(JsonValue, CountsNestingNotBrackets) {
  EXPECT_TRUE(parses("["s + repeated("[[],{}],", 1000) + "[]]"));
  Limits shallow;
  shallow.json_depth = 2;
  EXPECT_TRUE(parses("[[],[],{}]", shallow));
  EXPECT_EQ(code_of("[[],[[]]]", shallow), ErrorCode::Limit);
  EXPECT_TRUE(parses("7", shallow));
}

TEST(JsonValue, LooksAtTheDepthBeforeAnythingIsBuilt) {
  // All of these are no JSON either: that the limit is what is told shows that nothing was read yet.
  EXPECT_EQ(code_of(repeated("[", 65)), ErrorCode::Limit);
  EXPECT_EQ(code_of("nonsense "s + repeated("{", 65)), ErrorCode::Limit);
  EXPECT_EQ(code_of(repeated("[", 5'000'000)), ErrorCode::Limit);
  EXPECT_EQ(code_of(repeated("[", 64)), ErrorCode::Parse);
}

TEST(JsonValue, DoesNotCountBracketsInsideStrings) {
  EXPECT_TRUE(parses("\""s + repeated("[{", 1000) + "\""));
  EXPECT_TRUE(parses(R"(["\")"s + repeated("[", 1000) + R"("])"));
  EXPECT_TRUE(parses(R"({"\\\")"s + repeated("{", 1000) + R"(":1})"));
  // Here the string ends behind the escaped backslash: what follows counts.
  EXPECT_EQ(code_of(R"(["\\",)"s + repeated("[", 64) + repeated("]", 65)), ErrorCode::Limit);
  EXPECT_TRUE(parses(R"(["\\",)"s + repeated("[", 63) + repeated("]", 64)));
  EXPECT_EQ(code_of("\""s + repeated("[", 1000)), ErrorCode::Parse);
  EXPECT_EQ(code_of("\"\\"), ErrorCode::Parse);
}

TEST(JsonValue, RefusesNulBytesWhereverTheyStand) {
  for (const auto& text : {"\0"s, "{}\0"s, "{}\0nonsense"s, "\0{}"s, "[1,\0 2]"s, "\"a\0b\""s, "{\"a\0\":1}"s}) {
    EXPECT_EQ(code_of(text), ErrorCode::Parse);
  }
  const auto escaped = JsonValue::parse(R"({"value":"a\u0000b"})", {});
  ASSERT_TRUE(escaped);
  const auto decoded = decode<One<std::string>>(*escaped);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->value, "a\0b"s);
}

TEST(JsonValue, RefusesWhatIsNoJson) {
  for (const char* text : {"",
                           " ",
                           "{",
                           "}",
                           "[1,]",
                           "{\"a\":1,}",
                           "{a:1}",
                           "{'a':1}",
                           "[1 2]",
                           "[1] 2",
                           "{} {}",
                           "nul",
                           "True",
                           "NaN",
                           "Infinity",
                           "-",
                           "+1",
                           "01",
                           "1.",
                           ".5",
                           "1e",
                           "0x10",
                           "\"\t\"",
                           "\"\\x41\"",
                           "\"\\u12\"",
                           "\"\\ud800\"",
                           "\"\\udc00\\ud800\"",
                           "/* */ 1",
                           "1 // one",
                           "\"\xFF\"",
                           "\"\xC3\"",
                           "\"\xED\xA0\x80\""}) {
    EXPECT_EQ(code_of(text), ErrorCode::Parse) << text;
  }
}

TEST(JsonValue, TakesAnyValueOnItsOwn) {
  for (const char* text :
       {"null", "true", "false", "0", "-0", "1e5", "-1.5E-3", "\"\"", "\"\\ud83d\\ude00\"", "[]", "{}", " \t\r\n1\n"}) {
    EXPECT_TRUE(parses(text)) << text;
  }
}

TEST(JsonValue, RefusesNumbersThatNoDoubleHolds) {
  for (const char* text : {"1e400", "-1e400", "[1,2,1e309]", "{\"params\":{\"time\":1e999999999999}}"}) {
    EXPECT_EQ(code_of(text), ErrorCode::Parse) << text;
  }
  EXPECT_EQ(code_of(repeated("9", 400)), ErrorCode::Parse);
  EXPECT_TRUE(parses("1e-400"));
  EXPECT_TRUE(parses("1.7976931348623157e308"));
}

TEST(JsonValue, SaysWhereTheTextIsBroken) {
  const auto result = JsonValue::parse("{\"a\":1,\n  \"b\" 2}", {});
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("line 2"), std::string::npos) << result.error().message;
}

TEST(JsonValue, ExplainsInUtf8WhatIsBrokenInsideACharacter) {
  // The reader stops at the first byte of each; the answer must not hold half a character.
  for (const char* text :
       {"[\u0384]", "{\"a\":\u20ac}", "\U0001F600", "[1,\"ok\",\u00e9 ]", "tr\u00e9s", "1\u20ac", "\"\\\u00e9\""}) {
    const auto result = JsonValue::parse(text, {});
    ASSERT_FALSE(result) << text;
    EXPECT_EQ(result.error().code, ErrorCode::Parse);
    EXPECT_TRUE(is_utf8(result.error().message)) << result.error().message;
  }
}

TEST(JsonValue, IsAnEmptyObjectAtFirst) {
  EXPECT_TRUE(decode<None>(JsonValue()));
  EXPECT_FALSE(decode<One<bool>>(JsonValue()));
}

}  // namespace
}  // namespace tweend::protocol
