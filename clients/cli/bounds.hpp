#pragma once

#include <array>
#include <span>
#include <string>

namespace tweend::cli {

/// The box around points, as `(x, y, z) to (x, y, z)`; `-` where there are none.
/// @param xyz  three numbers a point
[[nodiscard]] std::string bounds_text(std::span<const float> xyz);

/// A point as `(x, y, z)`.
[[nodiscard]] std::string point_text(const std::array<float, 3>& point);

}  // namespace tweend::cli
