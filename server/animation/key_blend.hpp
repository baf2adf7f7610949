#pragma once

#include <array>
#include <cstdint>

#include "server/animation/interpolation.hpp"
#include "server/animation/key_timeline.hpp"

namespace tweend::animation {

/// Which keyframes make the value at a time, and how much of each: value = Σ weight[i] · key[i] over the first `count`.
/// The same numbers drive the blend on the CPU and the slots of the GPU, so both show the same.
struct KeyBlend {
  std::uint32_t count = 1;                              ///< 1 to 4
  std::array<std::uint32_t, 4> key{};                   ///< indices of keyframes, none twice
  std::array<float, 4> weight{1.0F, 0.0F, 0.0F, 0.0F};  ///< sum 1; a spline's or an overshooting easing's may be negative
  std::uint32_t nearest = 0;  ///< index into `key` of the keyframe nearer in time: where a blended normal has no length
};

/// The blend for a place on the timeline. Keyframes of vertices have no tangents: a cubic blend takes them as 0. Exactly on a
/// key it is that key alone, with weight 1. Pure; safe from any thread. The rules are those of docs/PROTOCOL.md, section 4.
/// @param segment  what `locate` found on the same timeline
/// @param easing   applied to u before a linear or Catmull-Rom blend; may be null
[[nodiscard]] KeyBlend blend_keys(const KeyTimeline& timeline, const KeySegment& segment, Interpolation mode,
                                  const CubicBezier* easing) noexcept;

}  // namespace tweend::animation
