#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "render/image_view.hpp"
#include "server/base/result.hpp"

namespace tweend::render {

/// Whether this build can write H.264 (CMake option TWEEND_H264).
[[nodiscard]] bool has_h264() noexcept;

struct H264Options {
  Size size;           ///< even sides
  double rate = 30.0;  ///< pictures a second that are to be expected
  /// What no second takes more bits than, as h264_least() counts its pictures; 0: as many as a constant quality takes.
  std::int64_t bit_rate = 0;
  /// For a stream: fast, Constrained Baseline, parameter sets within each IDR picture's unit. Else for a file: High profile,
  /// better packed, parameter sets apart.
  bool live = true;
};

/// Writes H.264 by x264 in FFmpeg: 4:2:0, no B-frames, closed groups of pictures that begin where they are asked to, every
/// picture's unit at once. Red, green and blue become BT.601's luma and chroma in limited range, of sRGB's primaries and
/// transfer; the bitstream says so. Not for the network thread; one thread at a time.
class H264Encoder {
 public:
  /// @return InvalidParams for odd sides, a rate that is none or a bit rate below h264_least(), Unavailable where the build has
  /// no H.264 or with the library's reason
  [[nodiscard]] static Result<H264Encoder> open(const H264Options& options);
  ~H264Encoder();
  H264Encoder(H264Encoder&&) noexcept;
  H264Encoder& operator=(H264Encoder&&) noexcept;

  struct Unit {
    std::span<const std::byte> bytes;  ///< an Annex B access unit; valid until the next call
    bool key = false;                  ///< an IDR picture
  };
  /// @param image  of the options' size
  /// @param key    whether it has to decode on its own; the first one does anyway
  /// @return InvalidParams for another size, Internal with the library's reason
  [[nodiscard]] Result<Unit> encode(const ImageView& image, bool key);

  /// Sequence and picture parameter set of a file, Annex B; empty of a stream.
  [[nodiscard]] std::span<const std::byte> parameter_sets() const noexcept;

  /// What WebCodecs calls a stream of this size and rate ("avc1.42c01f"), without opening anything.
  [[nodiscard]] static std::string codec(Size size, double rate);

 private:
  struct Impl;
  explicit H264Encoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tweend::render
