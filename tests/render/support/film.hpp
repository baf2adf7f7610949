#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/render/support/image.hpp"

namespace tweend::render::test {

/// What FFmpeg reads from H.264 or MP4.
struct Film {
  struct Picture {
    Image image;
    std::int64_t at = 0;  ///< presentation time, in `time_base_s`; of a bare stream its number
    bool key = false;
  };
  std::vector<Picture> pictures;
  double time_base_s = 0.0;
  double duration_s = 0.0;
  int profile = 0, level = 0;
  std::vector<std::string> complaints;  ///< what FFmpeg said at its level of warnings or worse
};

/// @param units  Annex B, one after the other
[[nodiscard]] Film decode_h264(const std::vector<std::vector<std::byte>>& units);
[[nodiscard]] Film decode_mp4(const std::string& path);

/// Peak signal-to-noise ratio over red, green and blue, dB.
[[nodiscard]] double psnr_db(const Image& a, const Image& b);

/// Picture `k` of a film with something that moves: soft slopes and a bright square, that goes right by two pixels a picture.
[[nodiscard]] Image moving_picture(Size size, std::size_t k);

}  // namespace tweend::render::test
