#include "protocol/utf8.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tweend::protocol {
namespace {

/// RFC 3629 by arithmetic: decode, then ask whether the number needed that many bytes and is a scalar value.
bool reference(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t size = lead < 0x80 ? 1 : lead >> 5U == 6 ? 2 : lead >> 4U == 14 ? 3 : lead >> 3U == 30 ? 4 : 0;
    if (size == 0 || i + size > text.size()) return false;
    std::uint32_t value = size == 1 ? lead : lead & ((1U << (7 - size)) - 1U);
    for (std::size_t k = 1; k < size; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      if (next >> 6U != 2) return false;
      value = value * 64 + (next & 63U);
    }
    constexpr std::array<std::uint32_t, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};
    if (value < kSmallest[size] || value > 0x10FFFF || (value >= 0xD800 && value <= 0xDFFF)) return false;
    i += size;
  }
  return true;
}

std::string character(std::uint32_t value) {
  const auto byte = [](std::uint32_t v) { return static_cast<char>(static_cast<unsigned char>(v)); };
  if (value < 0x80) return {byte(value)};
  if (value < 0x800) return {byte(0xC0 | value >> 6U), byte(0x80 | (value & 63U))};
  if (value < 0x10000) return {byte(0xE0 | value >> 12U), byte(0x80 | (value >> 6U & 63U)), byte(0x80 | (value & 63U))};
  return {byte(0xF0 | value >> 18U), byte(0x80 | (value >> 12U & 63U)), byte(0x80 | (value >> 6U & 63U)),
          byte(0x80 | (value & 63U))};
}

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int v : values) text += static_cast<char>(static_cast<unsigned char>(v));
  return text;
}

std::string quoted(const std::string& text) {
  std::string out;
  for (const char c : text) out += std::to_string(static_cast<unsigned char>(c)) + " ";
  return out;
}

TEST(Utf8, TakesWhatTheStandardCallsWellFormed) {
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(is_utf8(std::string(1, '\0')));
  EXPECT_TRUE(is_utf8("plain text, longer than eight bytes"));
  EXPECT_TRUE(is_utf8("caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80"));
  for (const auto& good : {bytes({0xC2, 0x80}), bytes({0xDF, 0xBF}), bytes({0xE0, 0xA0, 0x80}), bytes({0xED, 0x9F, 0xBF}),
                           bytes({0xEE, 0x80, 0x80}), bytes({0xEF, 0xBF, 0xBF}), bytes({0xF0, 0x90, 0x80, 0x80}),
                           bytes({0xF4, 0x8F, 0xBF, 0xBF})}) {
    EXPECT_TRUE(is_utf8(good)) << quoted(good);
  }
}

TEST(Utf8, RefusesOverlongFormsSurrogatesAndWhatLiesPastUnicode) {
  for (const auto& bad : {bytes({0x80}),
                          bytes({0xBF}),
                          bytes({0xC0, 0x80}),
                          bytes({0xC1, 0xBF}),
                          bytes({0xE0, 0x80, 0x80}),
                          bytes({0xE0, 0x9F, 0xBF}),
                          bytes({0xED, 0xA0, 0x80}),
                          bytes({0xED, 0xBF, 0xBF}),
                          bytes({0xF0, 0x80, 0x80, 0x80}),
                          bytes({0xF0, 0x8F, 0xBF, 0xBF}),
                          bytes({0xF4, 0x90, 0x80, 0x80}),
                          bytes({0xF5, 0x80, 0x80, 0x80}),
                          bytes({0xF8, 0x88, 0x80, 0x80, 0x80}),
                          bytes({0xFE}),
                          bytes({0xFF}),
                          bytes({0xC3}),
                          bytes({0xC3, 0x28}),
                          bytes({0xE2, 0x82}),
                          bytes({0xE2, 0x28, 0xA1}),
                          bytes({0xF0, 0x9F, 0x98}),
                          bytes({0xF0, 0x9F, 0x28, 0x80})}) {
    EXPECT_FALSE(is_utf8(bad)) << quoted(bad);
  }
}

TEST(Utf8, AgreesWithTheReferenceOnEveryTwoBytesAtEveryPlace) {
  std::size_t wrong = 0;
  for (int a = 0; a < 256; ++a) {
    for (int b = 0; b < 256; ++b) {
      const std::string pair = bytes({a, b});
      const bool expected = reference(pair);
      // Before, inside and behind the stretches that are taken eight bytes at a time.
      for (const std::size_t before : {0U, 6U, 7U, 8U, 15U}) {
        for (const std::size_t after : {0U, 1U, 9U}) {
          wrong += is_utf8(std::string(before, 'x') + pair + std::string(after, 'y')) != expected;
        }
      }
    }
  }
  EXPECT_EQ(wrong, 0U);
}

TEST(Utf8, AgreesWithTheReferenceOnEveryThreeBytes) {
  std::size_t wrong = 0;
  for (int a = 0xC0; a < 256; ++a) {
    for (int b = 0; b < 256; ++b) {
      for (int c = 0; c < 256; ++c) {
        const std::string three = bytes({a, b, c});
        wrong += is_utf8(three) != reference(three);
      }
    }
  }
  EXPECT_EQ(wrong, 0U);
}

TEST(Utf8, AgreesWithTheReferenceOnTheEdgesOfFourBytes) {
  const std::vector<int> edges{0x00, 0x7F, 0x80, 0x8F, 0x90, 0x9F, 0xA0, 0xBF, 0xC0, 0xFF};
  std::size_t wrong = 0;
  for (int a = 0xE0; a < 256; ++a) {
    for (int b = 0; b < 256; ++b) {
      for (const int c : edges) {
        for (const int d : edges) {
          const std::string four = bytes({a, b, c, d});
          wrong += is_utf8(four) != reference(four);
        }
      }
    }
  }
  EXPECT_EQ(wrong, 0U);
}

TEST(Utf8, TakesEveryCharacterAndNoneThatIsCutShort) {
  std::size_t wrong = 0;
  for (std::uint32_t value = 0; value <= 0x10FFFF; ++value) {
    if (value == 0xD800) value = 0xE000;
    const std::string text = character(value);
    wrong += !is_utf8(text);
    if (text.size() > 1) wrong += is_utf8(std::string_view(text).substr(0, text.size() - 1));
    if (text.size() > 1) wrong += is_utf8(std::string_view(text).substr(1));
  }
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace tweend::protocol
