#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace tweend::protocol {

/// Unit vectors as points of a square: the sphere is pressed onto an octahedron, whose lower half is folded out over the
/// corners of the upper one's shadow. Coordinates are integers from −kMost to kMost; an x of kNone says "no direction".
template <int kBits>
struct Octahedral {
  static constexpr std::int16_t kMost = static_cast<std::int16_t>((1 << (kBits - 1)) - 1);
  static constexpr std::int16_t kNone = static_cast<std::int16_t>(-kMost - 1);
};

/// Any two integers are a direction, or none: what comes out is of unit length or zero.
template <int kBits>
[[nodiscard]] inline std::array<float, 3> decode_octahedral(std::int16_t x, std::int16_t y) noexcept {
  using Square = Octahedral<kBits>;
  if (x == Square::kNone) return {};
  double u = static_cast<double>(x) / Square::kMost;
  double v = static_cast<double>(y) / Square::kMost;
  const double w = 1.0 - std::abs(u) - std::abs(v);
  if (w < 0.0) {
    const double folded = (1.0 - std::abs(v)) * (u < 0.0 ? -1.0 : 1.0);
    v = (1.0 - std::abs(u)) * (v < 0.0 ? -1.0 : 1.0);
    u = folded;
  }
  const double length = std::sqrt(u * u + v * v + w * w);
  return {static_cast<float>(u / length), static_cast<float>(v / length), static_cast<float>(w / length)};
}

}  // namespace tweend::protocol
