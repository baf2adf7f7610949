#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "protocol/type_info.hpp"
#include "tests/protocol/described.hpp"

namespace tweend::protocol {
namespace {

/// number = [ - ] int [ frac ] [ exp ] of RFC 8259, section 6.
bool is_json_number(const std::string& text) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t begin = i;
    while (i < text.size() && text[i] >= '0' && text[i] <= '9') ++i;
    return i - begin;
  };
  if (i < text.size() && text[i] == '-') ++i;
  const std::size_t first = i;
  if (digits() == 0 || (text[first] == '0' && i - first > 1)) return false;
  if (i < text.size() && text[i] == '.') {
    ++i;
    if (digits() == 0) return false;
  }
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
    if (digits() == 0) return false;
  }
  return i == text.size();
}

void expect_float(std::uint32_t bits) {
  const auto value = std::bit_cast<float>(bits);
  const std::string text = encode(value);
  if (!std::isfinite(value)) {
    EXPECT_EQ(text, "null");
    return;
  }
  ASSERT_TRUE(is_json_number(text)) << text;
  ASSERT_EQ(std::bit_cast<std::uint32_t>(std::strtof(text.c_str(), nullptr)), bits) << text;
  // A client that reads doubles and narrows them gets the same float.
  ASSERT_EQ(std::bit_cast<std::uint32_t>(static_cast<float>(std::strtod(text.c_str(), nullptr))), bits) << text;
}

TEST(Encode, FloatsReadBackBitForBit) {
  std::mt19937 random(17);
  for (int i = 0; i < 300'000; ++i) expect_float(static_cast<std::uint32_t>(random()));
  for (const std::uint32_t bits : {0U, 0x80000000U, 1U, 0x007FFFFFU, 0x00800000U, 0x7F7FFFFFU, 0xFF7FFFFFU, 0x3DCCCCCDU,
                                   0x7F800000U, 0xFF800000U, 0x7FC00000U}) {
    expect_float(bits);
  }
}

TEST(Encode, DoublesReadBackBitForBit) {
  std::mt19937_64 random(18);
  for (int i = 0; i < 300'000; ++i) {
    const std::uint64_t bits = random();
    const auto value = std::bit_cast<double>(bits);
    const std::string text = encode(value);
    if (!std::isfinite(value)) {
      ASSERT_EQ(text, "null");
      continue;
    }
    ASSERT_TRUE(is_json_number(text)) << text;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(std::strtod(text.c_str(), nullptr)), bits) << text;
  }
}

TEST(Encode, NumbersTakeNoMoreDigitsThanTheyNeed) {
  EXPECT_EQ(encode(0.1F), "0.1");
  EXPECT_EQ(encode(0.1), "0.1");
  EXPECT_EQ(encode(1.0F), "1");
  EXPECT_EQ(encode(-2.5), "-2.5");
  EXPECT_EQ(encode(std::numeric_limits<double>::infinity()), "null");
}

TEST(Encode, WritesTheExtremesOfIntegers) {
  EXPECT_EQ(encode(std::numeric_limits<std::int64_t>::min()), "-9223372036854775808");
  EXPECT_EQ(encode(std::numeric_limits<std::int64_t>::max()), "9223372036854775807");
  EXPECT_EQ(encode(std::numeric_limits<std::uint64_t>::max()), "18446744073709551615");
  EXPECT_EQ(encode(true), "true");
  EXPECT_EQ(encode(false), "false");
}

TEST(Encode, TextsReadBackWhateverTheyHold) {
  std::string all;
  for (int c = 0; c < 128; ++c) all += static_cast<char>(c);
  for (const std::string& text :
       {std::string(), all, std::string("\"\\/\b\f\n\r\t"), std::string("caf\u00e9 \u20ac \U0001F600"),
        std::string("\u2028\u2029\uFEFF"), std::string(3, '\0')}) {
    const std::string json = encode(text);
    for (const char c : json) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << "a raw control character";
    EXPECT_EQ(nlohmann::json::parse(json).get<std::string>(), text);
    const auto back = read<std::string>(json);
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, text);
  }
}

TEST(Encode, EscapesAsJsonWantsIt) {
  EXPECT_EQ(encode(std::string("a\"b\\c\n\x01\x1f")), R"("a\"b\\c\n\u0001\u001f")");
  std::string out = "x";
  append_json_string("y", out);
  EXPECT_EQ(out, "x\"y\"");
}

TEST(Encode, WritesEmptyListsAndObjects) {
  EXPECT_EQ(encode(std::vector<float>()), "[]");
  EXPECT_EQ(encode(std::vector<std::uint32_t>()), "[]");
  EXPECT_EQ(encode(std::vector<std::string>()), "[]");
  EXPECT_EQ(encode(std::vector<Part>(2)), "[{},{}]");
  EXPECT_EQ(encode(std::map<std::string, double>()), "{}");
  EXPECT_EQ(encode(None()), "{}");
  EXPECT_EQ(encode(Part()), "{}");
  EXPECT_EQ(encode(Base64Floats()), "\"\"");
}

TEST(Encode, WritesEachKindAsTheProtocolHasIt) {
  EXPECT_EQ(encode(glm::vec3(1.0F, -0.5F, 3.0F)), "[1,-0.5,3]");
  EXPECT_EQ(encode(glm::quat(0.25F, 1.0F, 2.0F, 3.0F)), "[1,2,3,0.25]");  // GLM: w first; the wire: last
  EXPECT_EQ(encode(std::array<double, 2>{0.0, 1.5}), "[0,1.5]");
  EXPECT_EQ(encode(std::vector<std::uint32_t>{0, 4294967295U}), "[0,4294967295]");
  EXPECT_EQ(encode(std::vector<std::int64_t>{-1, 2}), "[-1,2]");
  EXPECT_EQ(encode(Name{"hip.L"}), "\"hip.L\"");
  EXPECT_EQ(encode(Colour::Green), "\"green\"");
  EXPECT_EQ(encode(Base64Floats{{1.0F, -2.0F}}), "\"AACAPwAAAMA=\"");
  EXPECT_EQ(encode(Base64Indices{{0x04030201U}}), "\"AQIDBA==\"");
  EXPECT_EQ(encode(std::map<std::string, double>{{"b\n", 2.5}, {"a", 1.0}}), R"({"a":1,"b\n":2.5})");
  EXPECT_EQ(encode(JsonText{std::make_shared<const std::string>("{\"ready\":[1]}")}), "{\"ready\":[1]}");
}

TEST(Encode, LeavesOutWhatIsNotThereAndWritesNullWhereItMeansSomething) {
  EXPECT_EQ(encode(One<std::optional<double>>{}), "{}");
  EXPECT_EQ(encode(One<std::optional<double>>{2.0}), "{\"value\":2}");
  EXPECT_EQ(encode(One<Nullable<Colour>>{}), "{}");
  EXPECT_EQ(encode(One<Nullable<Colour>>{std::optional<Colour>()}), "{\"value\":null}");
  EXPECT_EQ(encode(One<Nullable<Colour>>{std::optional(Colour::Blue)}), "{\"value\":\"blue\"}");
}

TEST(Encode, KeepsTheFieldsInTheirOrder) {
  Whole whole{0.5, 2.0, Part{glm::vec3(1.0F), {}, Colour::Red}, std::vector<Part>{Part{}, Part{{}, std::vector{1.5F}, {}}}};
  EXPECT_EQ(encode(whole),
            R"({"from":0.5,"to":2,"transform":{"scale":[1,1,1],"colour":"red"},"parts":[{},{"positions":[1.5]}]})");
  const auto back = decode<Whole>(parsed(encode(whole)));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(encode(*back), encode(whole));
}

}  // namespace
}  // namespace tweend::protocol
