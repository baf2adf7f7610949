#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/image_view.hpp"

namespace tweend::render::test {

/// Red, green and blue of a pixel, sRGB, 0 to 255.
using Rgb = std::array<int, 3>;

/// A picture that can be looked at: RGB, top row first.
struct Image {
  Size size;
  std::vector<std::uint8_t> rgb;  ///< shape [height × width × 3]

  Image() = default;
  explicit Image(Size s) : size(s), rgb(std::size_t{3} * s.width * s.height) {}
  /// A copy of what was drawn.
  explicit Image(const ImageView& view);

  [[nodiscard]] Rgb at(std::size_t x, std::size_t y) const {
    const std::uint8_t* p = rgb.data() + 3 * (y * size.width + x);
    return {p[0], p[1], p[2]};
  }
  void set(std::size_t x, std::size_t y, const Rgb& color) {
    for (std::size_t c = 0; c < 3; ++c) rgb[3 * (y * size.width + x) + c] = static_cast<std::uint8_t>(color[c]);
  }
  bool operator==(const Image&) const = default;
};

/// The same picture as the GPU reads it: RGBA, bottom row first. `bytes` of the view are `storage`'s.
[[nodiscard]] ImageView upside_down(const Image& image, std::vector<std::byte>& storage);

/// What libspng reads from a PNG file; 0 × 0 pixels if it is none.
[[nodiscard]] Image decode_png(std::span<const std::byte> file);
[[nodiscard]] std::vector<std::byte> read_file(const std::string& path);
void write_file(const std::string& path, std::span<const std::byte> bytes);
void write_png(const std::string& path, const Image& image);

}  // namespace tweend::render::test
