#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace tweend::protocol {

// As docs/PROTOCOL.md states them.
inline constexpr double kPositionSteps = 0.51;       ///< of extent / 65535
inline constexpr double kFineNormalError = 7e-5;     ///< radians: 16 bits
inline constexpr double kShortNormalError = 1.1e-3;  ///< 12 bits

/// @param extent  of the packet's grid: half a step of it, and what float32 can't tell apart
inline void expect_near_positions(const std::vector<float>& in, const std::vector<float>& out,
                                  const std::array<float, 3>& extent) {
  for (std::size_t i = 0; i < in.size(); ++i) {
    ASSERT_NEAR(in[i], out[i], kPositionSteps * double{extent[i % 3]} / 65535 + std::abs(double{in[i]}) / (1 << 23)) << i;
  }
}

/// min xyz, extent xyz: what a packet begins with.
inline std::array<float, 3> extent_of(std::span<const std::byte> payload) {
  std::array<float, 3> extent{};
  std::memcpy(extent.data(), payload.data() + 12, sizeof extent);
  return extent;
}

/// Radians, of unit vectors; a zero one has to be zero again.
inline double worst_angle(const std::vector<float>& in, const std::vector<float>& out) {
  double worst = 0.0;
  for (std::size_t i = 0; i < in.size(); i += 3) {
    const double length = std::hypot(in[i], in[i + 1], in[i + 2]);
    const double out_length = std::hypot(out[i], out[i + 1], out[i + 2]);
    EXPECT_NEAR(out_length, length == 0.0 ? 0.0 : 1.0, 1e-6);
    if (length == 0.0) continue;
    const double chord = std::hypot(in[i] / length - out[i], in[i + 1] / length - out[i + 1], in[i + 2] / length - out[i + 2]);
    worst = std::max(worst, 2.0 * std::asin(chord / 2.0));
  }
  return worst;
}

}  // namespace tweend::protocol
