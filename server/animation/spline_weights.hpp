#pragma once

#include <array>
#include <cstdint>

#include "server/animation/key_timeline.hpp"

namespace tweend::animation {

/// Seconds from `segment.from` to `segment.to`, over the seam where `to` is not the key that follows.
[[nodiscard]] double segment_length_s(const KeyTimeline& timeline, const KeySegment& segment) noexcept;

/// The four keys of a Catmull-Rom segment (from, to, the one before, the one after), with their weights. Keys may repeat: at
/// open ends, and in closed clips of two or three keys.
struct CatmullRomWeights {
  std::array<std::uint32_t, 4> key{};
  std::array<double, 4> weight{};  ///< sum 1
};

/// A cubic Hermite segment whose tangents are (x[i+1] − x[i−1]) / (t[i+1] − t[i−1]), as weights of its keys. With even
/// spacing this is the uniform spline of E. Catmull and R. Rom (A class of local interpolating splines, 1974). The end key of
/// an open clip is repeated as far outside as its neighbour is inside; a closed clip goes on around the seam.
/// @param segment  between two different keys
/// @param u        of the way, eased; may leave [0, 1] where the easing overshoots
[[nodiscard]] CatmullRomWeights catmull_rom_weights(const KeyTimeline& timeline, const KeySegment& segment, double u) noexcept;

/// The cubic Hermite blend of glTF 2.0, appendix C.5: value = from · x0 + to · x1 + out · (out-tangent of x0) + in ·
/// (in-tangent of x1).
struct HermiteWeights {
  double from = 1.0;
  double to = 0.0;
  double out_tangent = 0.0;  ///< seconds
  double in_tangent = 0.0;
};

/// @param u  of a segment of `length_s`
[[nodiscard]] HermiteWeights hermite_weights(double u, double length_s) noexcept;

}  // namespace tweend::animation
