#include "server/animation/key_timeline.hpp"

#include <algorithm>
#include <cstddef>

namespace tweend::animation {
namespace {

constexpr double kLargestBelowOne = 1.0 - 0x1p-53;

KeySegment held(std::size_t key) {
  const auto index = static_cast<std::uint32_t>(key);
  return {index, index, 0.0};
}

/// A division of two nearly equal times may round up to 1, which belongs to the next segment.
KeySegment between(std::size_t from, std::size_t to, double passed_s, double length_s) {
  const double u = std::min(passed_s / length_s, kLargestBelowOne);
  return {static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(to), u};
}

/// The key at or before `time_s`, which lies in [front, back).
std::size_t key_before(std::span<const double> times_s, double time_s) {
  const std::size_t last = times_s.size() - 1;
  const double passed = (time_s - times_s.front()) / (times_s.back() - times_s.front());
  const auto guess = std::min(static_cast<std::size_t>(passed * static_cast<double>(last)), last - 1);
  // Right for evenly spaced keys, except that rounding may fall on the wrong side of one.
  for (std::size_t i = guess == 0 ? 0 : guess - 1; i <= std::min(guess + 1, last - 1); ++i) {
    if (times_s[i] <= time_s && time_s < times_s[i + 1]) return i;
  }
  return static_cast<std::size_t>(std::ranges::upper_bound(times_s, time_s) - times_s.begin()) - 1;
}

/// On the way from the last key to the first, `passed_s` seconds after the last.
KeySegment over_the_seam(const KeyTimeline& timeline, double passed_s) {
  const auto& times_s = timeline.times_s;
  const double length_s = timeline.duration_s - times_s.back() + times_s.front();
  if (passed_s >= length_s) return held(0);
  return between(times_s.size() - 1, 0, passed_s, length_s);
}

}  // namespace

KeySegment locate(const KeyTimeline& timeline, double time_s) noexcept {
  const auto& times_s = timeline.times_s;
  const std::size_t last = times_s.size() - 1;
  if (last == 0) return held(0);
  const double t = time_s > 0.0 ? std::min(time_s, timeline.duration_s) : 0.0;
  if (t == times_s.front()) return held(0);
  if (t == times_s.back()) return held(last);
  if (t < times_s.front()) return timeline.closed ? over_the_seam(timeline, timeline.duration_s - times_s.back() + t) : held(0);
  if (t > times_s.back()) return timeline.closed ? over_the_seam(timeline, t - times_s.back()) : held(last);
  const std::size_t from = key_before(times_s, t);
  if (t == times_s[from]) return held(from);
  return between(from, from + 1, t - times_s[from], times_s[from + 1] - times_s[from]);
}

}  // namespace tweend::animation
