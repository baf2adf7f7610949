#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "server/animation/interpolation.hpp"
#include "server/animation/key_timeline.hpp"
#include "server/animation/track.hpp"

namespace tweend::animation {

/// How the value of a track at one time is made of its keys: Σ weight[i] · source[i], except that Linear rotations slerp by
/// weight[1], and that blended rotations are scaled to unit length. The same for all tracks that share times and modes.
struct SegmentBlend {
  enum class Kind : std::uint8_t {
    Hold,        ///< key[0] alone
    Linear,      ///< key[0] to key[1]; weights 1 − u and u, which an easing may take out of [0, 1]
    CatmullRom,  ///< the values of all four keys, rotations each in the hemisphere of its neighbour
    Cubic,       ///< values of key[0] and key[1], out-tangent of key[2], in-tangent of key[3]; nothing is turned around
  };
  Kind kind = Kind::Hold;
  std::array<std::uint32_t, 4> key{};
  std::array<float, 4> weight{1.0F, 0.0F, 0.0F, 0.0F};
};

/// @param modes     a key each, or one for all; that of the key the segment starts from counts
/// @param fallback  for a key that names no interpolation
[[nodiscard]] SegmentBlend blend_segment(const KeyTimeline& timeline, std::span<const KeyMode> modes, double time_s,
                                         Interpolation fallback) noexcept;

}  // namespace tweend::animation
