#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "render/image_view.hpp"
#include "server/base/result.hpp"

namespace tweend::render {

/// Writes JPEG files (baseline, 4:2:0, sRGB) by libjpeg-turbo. One thread at a time; worth keeping, it holds its tables.
class JpegEncoder {
 public:
  JpegEncoder();
  ~JpegEncoder();
  JpegEncoder(JpegEncoder&&) noexcept;
  JpegEncoder& operator=(JpegEncoder&&) noexcept;

  /// What a picture of this size may take at most, bytes.
  [[nodiscard]] static std::size_t most_bytes(Size size) noexcept;

  /// @param quality  1 to 100
  /// @param out      room for most_bytes(image.size)
  /// @return how many bytes of `out` were written; Internal if there is less room, or with the library's reason; nothing is
  /// written past `out`
  [[nodiscard]] Result<std::size_t> encode(const ImageView& image, int quality, std::span<std::byte> out);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A whole JPEG file, for a picture that is made once. Any thread. @return as JpegEncoder::encode
[[nodiscard]] Result<std::vector<std::byte>> encode_jpeg(const ImageView& image, int quality);

/// Writes a PNG file (8 bits, RGB: the pictures are opaque; tagged sRGB) by libspng. Any thread.
/// @return Internal with the library's reason
[[nodiscard]] Result<std::vector<std::byte>> encode_png(const ImageView& image);

}  // namespace tweend::render
