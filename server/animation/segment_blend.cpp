#include "server/animation/segment_blend.hpp"

#include <cstddef>

#include "server/animation/spline_weights.hpp"

namespace tweend::animation {
namespace {

SegmentBlend catmull_rom(const KeyTimeline& timeline, const KeySegment& segment, double u) {
  const CatmullRomWeights spline = catmull_rom_weights(timeline, segment, u);
  SegmentBlend blend{.kind = SegmentBlend::Kind::CatmullRom, .key = spline.key};
  for (std::size_t i = 0; i < 4; ++i) blend.weight[i] = static_cast<float>(spline.weight[i]);
  return blend;
}

SegmentBlend cubic(const KeyTimeline& timeline, const KeySegment& segment) {
  const HermiteWeights weights = hermite_weights(segment.u, segment_length_s(timeline, segment));
  return {.kind = SegmentBlend::Kind::Cubic,
          .key = {segment.from, segment.to, segment.from, segment.to},
          .weight = {static_cast<float>(weights.from), static_cast<float>(weights.to), static_cast<float>(weights.out_tangent),
                     static_cast<float>(weights.in_tangent)}};
}

}  // namespace

SegmentBlend blend_segment(const KeyTimeline& timeline, std::span<const KeyMode> modes, double time_s,
                           Interpolation fallback) noexcept {
  const KeySegment segment = locate(timeline, time_s);
  const KeyMode& key_mode = modes[modes.size() == 1 ? 0 : segment.from];
  const Interpolation mode = key_mode.interpolation.value_or(fallback);
  if (segment.from == segment.to || mode == Interpolation::Step) return {.key = {segment.from}};
  if (mode == Interpolation::Cubic) return cubic(timeline, segment);
  const double u = key_mode.easing ? ease(*key_mode.easing, segment.u) : segment.u;
  if (mode == Interpolation::CatmullRom) return catmull_rom(timeline, segment, u);
  return {.kind = SegmentBlend::Kind::Linear,
          .key = {segment.from, segment.to},
          .weight = {static_cast<float>(1.0 - u), static_cast<float>(u)}};
}

}  // namespace tweend::animation
