#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "server/animation/track.hpp"
#include "server/base/result.hpp"
#include "server/model/actor.hpp"

namespace tweend::assets {

/// The keys of a value that moves, as a clip has them: a property of a joint, or some weights that are keyed together.
/// Numbers of a key stand side by side.
struct ExportTrack {
  std::size_t width = 1;                    ///< numbers of a value
  bool is_rotation = false;                 ///< unit quaternions xyzw
  std::vector<double> times_s{};            ///< strictly ascending, >= 0, at least one
  std::vector<float> values{};              ///< shape [keys × width]
  std::vector<float> in_tangents{};         ///< per second, the same shape, for cubic; empty: zero
  std::vector<float> out_tangents{};        ///< likewise
  std::vector<animation::KeyMode> modes{};  ///< a key each, each with an interpolation

  [[nodiscard]] std::span<const float> value(std::size_t key) const { return std::span(values).subspan(key * width, width); }
};

/// glTF's ways to blend the keys of a sampler.
enum class GlbBlend : std::uint8_t { Step, Linear, CubicSpline };

/// A track as an animation sampler of glTF holds it.
struct GlbSamples {
  GlbBlend blend = GlbBlend::Linear;
  std::vector<float> times_s;  ///< strictly ascending
  std::vector<float> values;   ///< a CubicSpline's: in-tangent, value and out-tangent of each key
};

/// How long the clip goes on, and how.
struct ClipSpan {
  double duration_s = 0.0;
  bool closed = false;
};

/// How near baked keys have to stay.
struct BakeLimits {
  double tolerance = 1e-6;             ///< of each number, relative where it is larger than 1; chains of joints add up
  std::size_t most_values = SIZE_MAX;  ///< numbers, all keys together
};

/// What a track shows, in double precision; the rules are those of animation::TrackSet. Pure.
/// @param out  shape [width]
void sample_export_track(const ExportTrack& track, const ClipSpan& clip, double time_s, std::span<double> out);

/// The same track by glTF's rules. Where one of its modes holds for all keys, it keeps its keys; `catmull_rom` becomes a
/// CUBICSPLINE of the same curve, and a closed track gets its first key once more at the clip's end. Everything else (modes
/// that change, easing, a curve that crosses the clip's end in the middle) is baked: a CUBICSPLINE with all the keys, and as
/// many between as the tolerance asks. Pure.
/// @return Limit where baking takes more than `limits.most_values`
[[nodiscard]] Result<GlbSamples> glb_samples(const ExportTrack& track, const ClipSpan& clip, const BakeLimits& limits = {});

}  // namespace tweend::assets
