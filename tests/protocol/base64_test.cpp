#include "protocol/base64.hpp"

#include <gtest/gtest.h>

#include <bitset>
#include <random>
#include <string>
#include <vector>

namespace tweend::protocol {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::vector<std::byte> bytes_of(std::string_view text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

std::string encoded(const std::vector<std::byte>& bytes) {
  std::string out;
  append_base64(bytes, out);
  return out;
}

/// By the text of RFC 4648: a row of bits, cut into sixes, filled up with zeros, then '=' up to a multiple of four.
std::string reference(const std::vector<std::byte>& bytes) {
  std::string bits, out;
  for (const std::byte b : bytes) bits += std::bitset<8>(std::to_integer<unsigned>(b)).to_string();
  while (bits.size() % 6 != 0) bits += '0';
  for (std::size_t i = 0; i < bits.size(); i += 6) out += kDigits[std::bitset<6>(bits.substr(i, 6)).to_ulong()];
  while (out.size() % 4 != 0) out += '=';
  return out;
}

void expect_refused(const std::string& text) {
  const auto result = decode_base64(text);
  ASSERT_FALSE(result) << text;
  EXPECT_EQ(result.error().code, ErrorCode::InvalidParams);
  EXPECT_FALSE(result.error().message.empty());
}

TEST(Base64, HasTheVectorsOfTheStandard) {
  const std::vector<std::pair<std::string, std::string>> vectors{{"", ""},
                                                                 {"f", "Zg=="},
                                                                 {"fo", "Zm8="},
                                                                 {"foo", "Zm9v"},
                                                                 {"foob", "Zm9vYg=="},
                                                                 {"fooba", "Zm9vYmE="},
                                                                 {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, text] : vectors) {
    EXPECT_EQ(encoded(bytes_of(plain)), text);
    const auto back = decode_base64(text);
    ASSERT_TRUE(back) << text;
    EXPECT_EQ(*back, bytes_of(plain));
  }
}

TEST(Base64, RoundTripsEveryLengthAsTheReferenceWritesIt) {
  std::mt19937 random(11);
  for (std::size_t length = 0; length <= 70; ++length) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      std::vector<std::byte> bytes(length);
      for (std::byte& b : bytes) b = static_cast<std::byte>(random() & 0xFFU);
      const std::string text = encoded(bytes);
      ASSERT_EQ(text, reference(bytes));
      const auto back = decode_base64(text);
      ASSERT_TRUE(back);
      ASSERT_EQ(*back, bytes);
    }
  }
}

TEST(Base64, AppendsToWhatIsThere) {
  std::string out = "{\"a\":\"";
  append_base64(bytes_of("foo"), out);
  EXPECT_EQ(out, "{\"a\":\"Zm9v");
}

TEST(Base64, RefusesEveryOtherCharacterAtEveryPlaceAndNamesIt) {
  for (int c = 0; c < 256; ++c) {
    const char character = static_cast<char>(static_cast<unsigned char>(c));
    if (kDigits.find(character) != std::string_view::npos) continue;
    for (std::size_t place = 0; place < 8; ++place) {
      if (character == '=' && place == 7) continue;  // padding
      std::string text = "QUJDREVG";
      text[place] = character;
      const auto result = decode_base64(text);
      ASSERT_FALSE(result) << c << " at " << place;
      EXPECT_EQ(result.error().code, ErrorCode::InvalidParams);
      EXPECT_NE(result.error().message.find("position " + std::to_string(place)), std::string::npos) << result.error().message;
      EXPECT_NE(result.error().message.find("code " + std::to_string(c)), std::string::npos) << result.error().message;
    }
  }
}

TEST(Base64, RefusesLengthsThatAreNoMultipleOfFour) {
  for (std::size_t length = 1; length <= 21; ++length) {
    if (length % 4 == 0) continue;
    const std::string text(length, 'A');
    expect_refused(text);
    EXPECT_NE(decode_base64(text).error().message.find(std::to_string(length)), std::string::npos);
  }
}

TEST(Base64, RefusesPaddingAnywhereButAtTheEnd) {
  for (const char* text : {"====", "A===", "=AAA", "A=AA", "AA=A", "AA==AAAA", "AAA=AAAA", "AAAA====", "AAAAA==="}) {
    expect_refused(text);
  }
}

TEST(Base64, RefusesTheUrlAlphabetAndWhiteSpace) {
  for (const char* text : {"-_-_", "QUJD\nQUJ", " QUJDRE ", "QUJD QUJD QU"}) expect_refused(text);
}

}  // namespace
}  // namespace tweend::protocol
