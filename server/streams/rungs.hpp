#pragma once

#include <array>
#include <cstddef>

#include "render/picture.hpp"

namespace tweend::streams {

/// One step of the ladder of qualities and sizes that JPEG streams go down where a reader can't take more.
struct Rung {
  double scale;    ///< of each side
  double quality;  ///< of the quality that was asked for
};

/// From what was asked for down; each takes some two thirds of the bytes of the one above.
inline constexpr std::array<Rung, 7> kRungs{
    {{1.0, 1.0}, {1.0, 0.7}, {0.75, 0.7}, {0.625, 0.6}, {0.5, 0.55}, {0.375, 0.5}, {0.25, 0.5}}};

/// What a picture of `size` has on a rung: at least a pixel a side.
[[nodiscard]] render::Size size_on_rung(render::Size size, std::size_t rung) noexcept;
/// @return 1 to 100
[[nodiscard]] int quality_on_rung(int quality, std::size_t rung) noexcept;

}  // namespace tweend::streams
