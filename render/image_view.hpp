#pragma once

#include <cstddef>
#include <span>

#include "render/picture.hpp"

namespace tweend::render {

/// A drawn picture, borrowed: RGBA, 8 bits a channel, sRGB, **bottom row first** as OpenGL reads it, rows without gaps.
struct ImageView {
  Size size;
  std::span<const std::byte> bytes;  ///< shape [height × width × 4]

  [[nodiscard]] std::size_t row_bytes() const noexcept { return std::size_t{4} * size.width; }
  /// Row `y` counted from the top.
  [[nodiscard]] std::span<const std::byte> row(std::size_t y) const noexcept {
    return bytes.subspan((size.height - 1 - y) * row_bytes(), row_bytes());
  }
};

}  // namespace tweend::render
