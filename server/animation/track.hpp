#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <span>

#include "server/animation/interpolation.hpp"
#include "server/animation/pose.hpp"

namespace tweend::animation {

/// What a track moves (glTF's `path`).
enum class Property : std::uint8_t { Translation, Rotation, Scale, Weight };

/// One property of one joint, or one morph weight.
struct Channel {
  std::uint32_t target = 0;  ///< index of the joint, or of the weight
  Property property = Property::Translation;
  auto operator<=>(const Channel&) const = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 misreads it
};

/// How a key blends towards the next.
struct KeyMode {
  std::optional<Interpolation> interpolation;  ///< empty: what sampling falls back to
  std::optional<CubicBezier> easing;           ///< applied to u before a linear or Catmull-Rom blend
  bool operator==(const KeyMode&) const = default;
};

/// The keys of one channel, borrowed.
struct TrackSource {
  Channel channel;                         ///< joints by their place in the order of evaluation
  std::span<const double> times_s;         ///< strictly ascending, >= 0, at least one
  std::span<const glm::vec4> values;       ///< a key each: xyz, rotations unit xyzw, weights x
  std::span<const glm::vec4> in_tangents;  ///< per second, for cubic; empty: zero
  std::span<const glm::vec4> out_tangents;
  std::span<const KeyMode> modes;  ///< a key each; or one for all
};

/// All tracks of a skeletal clip, packed for sampling: tracks that share their times are looked up once and blended side by
/// side. Immutable; safe from any thread.
class TrackSet {
 public:
  /// @param sources     each channel at most once
  /// @param duration_s  of the clip, at or beyond the last key; a closed one blends over its seam, each track from its last
  ///                    key to its first
  TrackSet(std::span<const TrackSource> sources, double duration_s, bool closed);
  ~TrackSet();
  TrackSet(TrackSet&&) noexcept;
  TrackSet& operator=(TrackSet&&) noexcept;

  /// Writes what the tracks show at `time_s` into `pose`; channels without a track stay as they are.
  /// The rules are those of glTF 2.0 (appendix C) and of docs/PROTOCOL.md, section 4; rotations slerp the short way.
  /// Costs the same wherever the last time was. Pure; allocates nothing.
  /// @param time_s    clamped to [0, duration]; NaN counts as 0
  /// @param fallback  for keys that name no interpolation
  /// @param pose      has every joint and weight that a source named
  void sample(double time_s, Interpolation fallback, Pose& pose) const noexcept;

 private:
  struct Packed;
  std::unique_ptr<const Packed> packed_;
};

}  // namespace tweend::animation
