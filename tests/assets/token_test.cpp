#include "server/assets/token.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace std::literals;

namespace tweend::assets {
namespace {

TEST(Token, ReadsDecimalNumbers) {
  const std::pair<std::string_view, float> cases[] = {
      {"0", 0.0F},  {"1", 1.0F},        {"-1.5", -1.5F},  {"+1.5", 1.5F},     {".5", 0.5F},  {"-.5", -0.5F},
      {"5.", 5.0F}, {"1e3", 1000.0F},   {"1E-3", 0.001F}, {"0.100000", 0.1F}, {"007", 7.0F}, {"3.4028234e38", 3.4028234e38F},
      {"1e-50", 0}, {"-1e-45", -1e-45F}};
  for (const auto& [token, number] : cases) EXPECT_EQ(parse_number(token), number) << token;
  EXPECT_TRUE(std::signbit(*parse_number("-0.0")));
}

TEST(Token, RefusesWhatIsNotWhollyAFiniteNumber) {
  for (const auto token :
       {""sv,     "+"sv,   "-"sv,    "."sv,        "abc"sv,   "1abc"sv,   "1,5"sv,    "0x10"sv, "nan"sv,     "NaN"sv,
        "-nan"sv, "inf"sv, "-inf"sv, "infinity"sv, "1e999"sv, "1e-400"sv, "-1e999"sv, "1e39"sv, "3.5e38"sv,  "1e"sv,
        "1e+"sv,  "--1"sv, "+-1"sv,  "++1"sv,      "1.2.3"sv, "1 "sv,     " 1"sv,     "1f"sv,   "1.#QNAN"sv, "1\0"sv}) {
    EXPECT_EQ(parse_number(token), std::nullopt) << token;
  }
}

TEST(Token, ReadsIntegers) {
  EXPECT_EQ(parse_integer("12"), 12);
  EXPECT_EQ(parse_integer("-12"), -12);
  EXPECT_EQ(parse_integer("0010"), 10);
  EXPECT_EQ(parse_integer("9223372036854775807"), 9223372036854775807);
  for (const auto token : {""sv, "-"sv, "+1"sv, "1.0"sv, "1a"sv, "0x1"sv, "9223372036854775808"sv}) {
    EXPECT_EQ(parse_integer(token), std::nullopt) << token;
  }
}

TEST(Token, QuotesAnythingAsPrintableText) {
  EXPECT_EQ(quoted_token("abc"), "\"abc\"");
  EXPECT_EQ(quoted_token("a\x01\xFF"), "\"a\\x01\\xff\"");
  EXPECT_EQ(quoted_token(std::string(41, 'x')), '"' + std::string(40, 'x') + "...\"");
}

}  // namespace
}  // namespace tweend::assets
