#pragma once

#include <cstdint>

namespace tweend::animation {

/// How values between two keyframes are made; docs/PROTOCOL.md, section 4.
enum class Interpolation : std::uint8_t { Step, Linear, CatmullRom, Cubic };

/// A CSS `cubic-bezier(x1, y1, x2, y2)`: the curve from (0, 0) to (1, 1) with these two control points.
/// x1 and x2 lie in [0, 1], so that x grows along the curve; y may leave [0, 1] (overshoot).
struct CubicBezier {
  double x1 = 0.0;
  double y1 = 0.0;
  double x2 = 1.0;
  double y2 = 1.0;
  bool operator==(const CubicBezier&) const = default;
};

/// The curve's y where its x is `u` (CSS Easing Functions Level 1, section 2.2), to about 1e-7.
/// Pure; safe from any thread.
/// @param u  clamped to [0, 1]; 0 gives exactly 0 and 1 exactly 1
[[nodiscard]] double ease(const CubicBezier& curve, double u) noexcept;

}  // namespace tweend::animation
