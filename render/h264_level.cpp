#include "render/h264_level.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tweend::render {
namespace {

constexpr std::array<H264Level, 11> kLevels{{{30, 40'500, 1'620, 10'000'000},
                                             {31, 108'000, 3'600, 14'000'000},
                                             {32, 216'000, 5'120, 20'000'000},
                                             {40, 245'760, 8'192, 20'000'000},
                                             {42, 522'240, 8'704, 50'000'000},
                                             {50, 589'824, 22'080, 135'000'000},
                                             {51, 983'040, 36'864, 240'000'000},
                                             {52, 2'073'600, 36'864, 240'000'000},
                                             {60, 4'177'920, 139'264, 240'000'000},
                                             {61, 8'355'840, 139'264, 480'000'000},
                                             {62, 16'711'680, 139'264, 800'000'000}}};

/// Measured over sizes from 64 × 64 to 1920 × 1080 and pictures of noise: a key takes 389 bits and 6.03 for each macroblock,
/// any other picture 92. Rounded up.
constexpr std::int64_t kKeyBits = 500, kKeyMacroblockBits = 7, kOtherBits = 100;
constexpr std::int64_t kKeysASecond = 5;
/// Of what is left x264 takes whole thousands, a fifth of it for its buffer.
constexpr std::int64_t kLeastToShare = 10'000;

constexpr std::int64_t macroblocks_across(std::uint32_t pixels) noexcept { return (std::int64_t{pixels} + 15) / 16; }

}  // namespace

const H264Level& h264_level(Size size, double rate) noexcept {
  const std::int64_t width = macroblocks_across(size.width), height = macroblocks_across(size.height);
  const std::int64_t picture = width * height, longest = std::max(width, height);
  const auto* found = std::find_if(kLevels.begin(), kLevels.end(), [&](const H264Level& level) {
    // A side may be as long as that of a picture eight times as long as high.
    return picture <= level.macroblocks && longest * longest <= 8 * level.macroblocks &&
           static_cast<double>(picture) * rate <= static_cast<double>(level.macroblocks_s);
  });
  return found == kLevels.end() ? kLevels.back() : *found;
}

H264Least h264_least(Size size, double rate) noexcept {
  const std::int64_t key = kKeyBits + kKeyMacroblockBits * macroblocks_across(size.width) * macroblocks_across(size.height);
  const std::int64_t others = kOtherBits * static_cast<std::int64_t>(std::ceil(h264_paced(rate)) + 1.0);
  const std::int64_t bits_s = kKeysASecond * key + others;
  return {bits_s, bits_s + key + kLeastToShare};
}

}  // namespace tweend::render
