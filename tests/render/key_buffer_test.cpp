#include "render/key_buffer.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "tests/render/support/offscreen.hpp"

namespace tweend::render {
namespace {

constexpr std::size_t kFloats = 18;
constexpr std::size_t kSlotBytes = kFloats * sizeof(float);

/// Keyframe n holds n, n + 1/100, n + 2/100 …
std::vector<float> block_of(std::size_t key) {
  std::vector<float> block;
  for (std::size_t i = 0; i < kFloats; ++i) block.push_back(static_cast<float>(key) + 0.01F * static_cast<float>(i));
  return block;
}

class KeyBufferOnGpu : public testing::Test {
 protected:
  KeyBufferOnGpu() {
    for (std::size_t key = 0; key < 64; ++key) blocks_.push_back(block_of(key));
  }
  std::array<GLintptr, 4> place(KeyBuffer& buffer, const std::vector<std::size_t>& keys, std::size_t expected = 1) {
    std::vector<KeySource> sources;
    for (const std::size_t key : keys) sources.push_back({{7, key}, blocks_[key]});
    return buffer.place(sources, expected);
  }
  /// Places the keys, and looks whether each is where it is said to be.
  void expect_placed(KeyBuffer& buffer, const std::vector<std::size_t>& keys, std::size_t expected = 1) {
    const auto offsets = place(buffer, keys, expected);
    std::set<GLintptr> places;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      EXPECT_EQ(test::read_buffer(buffer.name(), offsets[i], kFloats), blocks_[keys[i]]) << "keyframe " << keys[i];
      places.insert(offsets[i]);
    }
    EXPECT_EQ(places.size(), keys.size()) << "two keyframes share a slot";
  }
  test::Offscreen gpu_;
  std::vector<std::vector<float>> blocks_;
};

TEST_F(KeyBufferOnGpu, WritesEachKeyframeOnceHoweverOftenItIsShown) {
  KeyBuffer buffer(kFloats, 1U << 20U);
  for (int round = 0; round < 3; ++round) {
    for (std::size_t key = 0; key + 1 < 10; ++key) expect_placed(buffer, {key, key + 1}, 10);
  }
  EXPECT_EQ(buffer.uploads(), 10U);
  EXPECT_EQ(buffer.bytes(), 10 * kSlotBytes) << "the first picture makes room for all that are expected";
}

TEST_F(KeyBufferOnGpu, AnAddedKeyframeWritesItselfAndNothingElse) {
  KeyBuffer buffer(kFloats, 1U << 20U);
  for (std::size_t key = 0; key < 5; ++key) expect_placed(buffer, {key}, 5);
  expect_placed(buffer, {4, 5}, 6);
  EXPECT_EQ(buffer.uploads(), 6U);
  for (std::size_t key = 0; key < 6; ++key) expect_placed(buffer, {key}, 6);
  EXPECT_EQ(buffer.uploads(), 6U) << "growing keeps what is there";
}

TEST_F(KeyBufferOnGpu, GrowsWithMoreKeyframesThanWereExpected) {
  KeyBuffer buffer(kFloats, 1U << 20U);
  for (std::size_t key = 0; key < 64; ++key) expect_placed(buffer, {key});
  for (std::size_t key = 0; key < 61; ++key) expect_placed(buffer, {key, key + 1, key + 2, key + 3});
  EXPECT_EQ(buffer.uploads(), 64U);
  EXPECT_LE(buffer.bytes(), 128 * kSlotBytes);
}

TEST_F(KeyBufferOnGpu, WritesOverWhatWasUsedLeastLatelyBeyondItsBudget) {
  KeyBuffer buffer(kFloats, 5 * kSlotBytes);
  for (std::size_t key = 0; key < 5; ++key) expect_placed(buffer, {key}, 64);
  EXPECT_EQ(buffer.bytes(), 5 * kSlotBytes);
  expect_placed(buffer, {0});  // now 1 is the one that was used least lately
  expect_placed(buffer, {5});
  EXPECT_EQ(buffer.uploads(), 6U);
  for (const std::size_t key : {0U, 2U, 3U, 4U, 5U}) expect_placed(buffer, {key});
  EXPECT_EQ(buffer.uploads(), 6U) << "they were still there";
  expect_placed(buffer, {1});
  EXPECT_EQ(buffer.uploads(), 7U);
  EXPECT_EQ(buffer.bytes(), 5 * kSlotBytes);
}

TEST_F(KeyBufferOnGpu, HasRoomForFourWhateverItsBudget) {
  KeyBuffer buffer(kFloats, 0);
  expect_placed(buffer, {0, 1, 2, 3}, 64);
  expect_placed(buffer, {9, 8, 7, 6}, 64);
  EXPECT_EQ(buffer.bytes(), 4 * kSlotBytes);
  EXPECT_EQ(buffer.uploads(), 8U);
}

TEST_F(KeyBufferOnGpu, NeverWritesOverAKeyframeOfTheSamePicture) {
  // Backwards over more keyframes than there is room for, the new one is the first of each picture.
  for (const bool backwards : {false, true}) {
    KeyBuffer buffer(kFloats, 4 * kSlotBytes);
    for (std::size_t step = 0; step + 3 < 20; ++step) {
      const std::size_t at = backwards ? 16 - step : step;
      expect_placed(buffer, {at, at + 1, at + 2, at + 3}, 20);
      EXPECT_EQ(buffer.uploads(), 4 + step) << "each picture brought one new keyframe";
    }
  }
}

}  // namespace
}  // namespace tweend::render
