#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "server/assets/export_track.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

/// A value over time, to be baked.
struct BakeSource {
  std::size_t width = 1;
  bool is_rotation = false;
  std::function<void(double time_s, std::span<double> out)> at;
  std::vector<double> times_s;  ///< strictly ascending, at least one: become keys; only there the value may jump or bend
};

/// A jump is made of two keys so far apart: nearer ones would be one keyframe when the file is read back (1 µs), and floats
/// tell them apart for the first ten seconds.
inline constexpr double kJumpSeconds = 2e-6;

/// Cubic pieces (a CUBICSPLINE) that follow the source as near as `limits` ask, between its times as many as it takes: halves,
/// and their halves, down to a 16,384th. Pieces of the fourth order need a fiftieth of the keys that straight ones would. Pure.
/// @return Limit where they are more than `limits.most_values` numbers
[[nodiscard]] Result<GlbSamples> bake(const BakeSource& source, const BakeLimits& limits);

/// Numbers as floats, ascending as they were, however near they are.
[[nodiscard]] std::vector<float> float_times(std::span<const double> times_s);

/// The way from one unit quaternion (xyzw) to another, or to its opposite where that is nearer.
void slerp(std::span<const double> from, std::span<const double> to, double u, std::span<double> out);

}  // namespace tweend::assets
