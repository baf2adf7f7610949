#pragma once

#include <cstdint>
#include <span>

namespace tweend::animation {

/// When the keyframes of a clip are, borrowed.
struct KeyTimeline {
  std::span<const double> times_s;  ///< strictly ascending, >= 0, not empty
  double duration_s = 0.0;          ///< >= times_s.back(); beyond it if closed
  bool closed = false;              ///< blends from the last key back to the first over the rest of the duration
};

/// Where a time falls among the keyframes. `from` and `to` are equal where a key is held: exactly on it, before the
/// first or after the last of an open clip, or because there is only one.
struct KeySegment {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  double u = 0.0;  ///< how much of the way from `from` to `to` has passed, 0 <= u < 1
};

/// Finds the keyframes on both sides of a time, in constant time where they are evenly spaced.
/// Pure; safe from any thread.
/// @param time_s  clamped to [0, duration] (looping is playback's job); NaN counts as 0
/// @return in a closed clip also the way from the last key over the seam to the first, on both sides of time 0
[[nodiscard]] KeySegment locate(const KeyTimeline& timeline, double time_s) noexcept;

}  // namespace tweend::animation
