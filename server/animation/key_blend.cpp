#include "server/animation/key_blend.hpp"

#include <cstddef>

namespace tweend::animation {
namespace {

/// Gathers weights in double and merges those of the same key: short clips meet a key twice.
class BlendBuilder {
 public:
  void add(std::uint32_t key, double weight) {
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (key_[i] == key) {
        weight_[i] += weight;
        return;
      }
    }
    key_[count_] = key;
    weight_[count_++] = weight;
  }

  [[nodiscard]] KeyBlend build(std::uint32_t nearest_key) const {
    KeyBlend blend{.count = count_, .key = key_};
    for (std::uint32_t i = 0; i < count_; ++i) {
      blend.weight[i] = static_cast<float>(weight_[i]);
      if (key_[i] == nearest_key) blend.nearest = i;
    }
    return blend;
  }

 private:
  std::uint32_t count_ = 0;
  std::array<std::uint32_t, 4> key_{};
  std::array<double, 4> weight_{};
};

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

/// Seconds from `from` to `to`, over the seam where `to` is not the key that follows.
double segment_length_s(const KeyTimeline& timeline, const KeySegment& segment) {
  const double length_s = timeline.times_s[segment.to] - timeline.times_s[segment.from];
  return segment.to > segment.from ? length_s : length_s + timeline.duration_s;
}

/// A cubic Hermite segment whose tangents are (x[i+1] − x[i−1]) / (t[i+1] − t[i−1]), as weights of its four keys. With
/// even spacing this is the uniform spline of E. Catmull and R. Rom (A class of local interpolating splines, 1974).
void add_catmull_rom(const KeyTimeline& timeline, const KeySegment& segment, double u, BlendBuilder& out) {
  const double h = segment_length_s(timeline, segment);
  const Neighbour previous = before(timeline, segment.from, h);
  const Neighbour next = after(timeline, segment.to, h);
  const double v = 1.0 - u;
  const double from_tangent = u * v * v * (h / (previous.distance_s + h));
  const double to_tangent = -u * u * v * (h / (h + next.distance_s));
  out.add(segment.from, v * v * (1.0 + 2.0 * u) - to_tangent);
  out.add(segment.to, u * u * (1.0 + 2.0 * v) + from_tangent);
  out.add(previous.key, -from_tangent);
  out.add(next.key, to_tangent);
}

}  // namespace

KeyBlend blend_keys(const KeyTimeline& timeline, const KeySegment& segment, Interpolation mode,
                    const CubicBezier* easing) noexcept {
  if (segment.from == segment.to || mode == Interpolation::Step) return {.key = {segment.from}};
  const double u = easing != nullptr ? ease(*easing, segment.u) : segment.u;
  BlendBuilder builder;
  if (mode == Interpolation::CatmullRom) {
    add_catmull_rom(timeline, segment, u, builder);
  } else {
    builder.add(segment.from, 1.0 - u);
    builder.add(segment.to, u);
  }
  // Nearer by the clock, not by the eased u.
  return builder.build(segment.u <= 0.5 ? segment.from : segment.to);
}

}  // namespace tweend::animation
