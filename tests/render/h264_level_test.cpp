#include "render/h264_level.hpp"

#include <gtest/gtest.h>

#include "render/h264_encoder.hpp"

namespace tweend::render {
namespace {

TEST(H264Level, IsWhatUsualSizesAreKnownToTake) {
  const auto level = [](std::uint32_t width, std::uint32_t height, double rate) {
    return h264_level({width, height}, rate).idc;
  };
  EXPECT_EQ(level(720, 576, 25), 30);
  EXPECT_EQ(level(1280, 720, 30), 31);
  EXPECT_EQ(level(1280, 720, 60), 32);
  EXPECT_EQ(level(1920, 1080, 30), 40);
  EXPECT_EQ(level(1920, 1080, 60), 42);
  EXPECT_EQ(level(3840, 2160, 30), 51);
  EXPECT_EQ(level(3840, 2160, 60), 52);
}

TEST(H264Level, IsNeverOneThatDecodersOfTodayGoBeyond) { EXPECT_EQ(h264_level({2, 2}, 0.1).idc, 30); }

TEST(H264Level, CountsPartsOfMacroblocksAsWhole) {
  // 1,620 macroblocks, and one row more by a pixel pair.
  EXPECT_EQ(h264_level({720, 576}, 25.0).idc, 30);
  EXPECT_EQ(h264_level({720, 578}, 1.0).idc, 31);
}

TEST(H264Level, LooksAtTheLongestSide) {
  // 300 macroblocks across are more than the 169 that level 3.1 has as its longest side.
  const H264Level& level = h264_level({4'800, 16}, 1.0);
  EXPECT_GE(8 * level.macroblocks, 300 * 300);
  EXPECT_GT(level.idc, 31);
}

TEST(H264Level, OfWhatNoLevelAllowsIsTheHighest) { EXPECT_EQ(h264_level({16'384, 16'384}, 240.0).idc, 62); }

TEST(H264Codec, NamesConstrainedBaselineAndTheLevel) {
  EXPECT_EQ(H264Encoder::codec({1280, 720}, 30.0), "avc1.42c01f");
  EXPECT_EQ(H264Encoder::codec({1920, 1080}, 60.0), "avc1.42c02a");
}

}  // namespace
}  // namespace tweend::render
