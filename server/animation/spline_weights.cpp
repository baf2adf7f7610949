#include "server/animation/spline_weights.hpp"

#include <cstddef>

namespace tweend::animation {
namespace {

struct Neighbour {
  std::uint32_t key;
  double distance_s;  ///< from the segment's end that it stands beside
};

/// The key before `from`: around the seam in a closed clip, and at the start of an open one the key itself, repeated
/// as far outside as `to` is inside.
Neighbour before(const KeyTimeline& timeline, std::uint32_t from, double segment_s) {
  const auto& times_s = timeline.times_s;
  if (from > 0) return {from - 1, times_s[from] - times_s[from - 1]};
  if (!timeline.closed) return {from, segment_s};
  return {static_cast<std::uint32_t>(times_s.size() - 1), timeline.duration_s - times_s.back() + times_s.front()};
}

/// The key after `to`, likewise.
Neighbour after(const KeyTimeline& timeline, std::uint32_t to, double segment_s) {
  const auto& times_s = timeline.times_s;
  if (to + std::size_t{1} < times_s.size()) return {to + 1, times_s[to + 1] - times_s[to]};
  if (!timeline.closed) return {to, segment_s};
  return {0, timeline.duration_s - times_s.back() + times_s.front()};
}

}  // namespace

double segment_length_s(const KeyTimeline& timeline, const KeySegment& segment) noexcept {
  const double length_s = timeline.times_s[segment.to] - timeline.times_s[segment.from];
  return segment.to > segment.from ? length_s : length_s + timeline.duration_s;
}

CatmullRomWeights catmull_rom_weights(const KeyTimeline& timeline, const KeySegment& segment, double u) noexcept {
  const double h = segment_length_s(timeline, segment);
  const Neighbour previous = before(timeline, segment.from, h);
  const Neighbour next = after(timeline, segment.to, h);
  const double v = 1.0 - u;
  const double from_tangent = u * v * v * (h / (previous.distance_s + h));
  const double to_tangent = -u * u * v * (h / (h + next.distance_s));
  return {{segment.from, segment.to, previous.key, next.key},
          {v * v * (1.0 + 2.0 * u) - to_tangent, u * u * (1.0 + 2.0 * v) + from_tangent, -from_tangent, to_tangent}};
}

HermiteWeights hermite_weights(double u, double length_s) noexcept {
  const double v = 1.0 - u;
  return {v * v * (1.0 + 2.0 * u), u * u * (1.0 + 2.0 * v), u * v * v * length_s, -u * u * v * length_s};
}

}  // namespace tweend::animation
