#pragma once

#include <cstdint>

#include "render/picture.hpp"

namespace tweend::render {

/// What a decoder has to be able to do: a row of Table A-1 of ITU-T H.264.
struct H264Level {
  int idc;                     ///< ten times its number: 31 is level 3.1
  std::int64_t macroblocks_s;  ///< 16 × 16 pixels each, a second
  std::int64_t macroblocks;    ///< of a picture
  std::int64_t bit_rate;       ///< bits a second, in the Baseline and Main profiles; also how many bits wait at most
};

/// The lowest level from 3 on that allows pictures of this size, so many a second; 6.2 if none does. From 3 on, since whatever
/// decodes today does that, and lower ones allow less than 10 Mbit/s.
[[nodiscard]] const H264Level& h264_level(Size size, double rate) noexcept;

/// How long a side x264 takes.
inline constexpr std::uint32_t kH264MostPixels = 16'384;

/// Pictures a second that a limit of bits reckons with: keys that are asked for come up to four times a second.
[[nodiscard]] constexpr double h264_paced(double rate) noexcept { return rate < 4.0 ? 4.0 : rate; }

/// The coarsest pictures there are, as x264 writes them whatever they show. A second has five keys at most, and one picture
/// more than its rate, beside those that are keys because what is shown has jumped.
struct H264Least {
  std::int64_t bits_s;    ///< of a second of nothing but these
  std::int64_t bit_rate;  ///< what a limit has to be at least, so that something is left to do better with
};
[[nodiscard]] H264Least h264_least(Size size, double rate) noexcept;

}  // namespace tweend::render
