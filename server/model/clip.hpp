#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/animation/interpolation.hpp"
#include "server/animation/key_timeline.hpp"
#include "server/animation/track.hpp"
#include "server/model/memo.hpp"
#include "server/model/pose_key.hpp"
#include "server/model/skeleton.hpp"
#include "server/model/vertex_key.hpp"

namespace tweend::model {

using KeyframeId = std::int64_t;

/// Two keyframes nearer than this are one (docs/PROTOCOL.md, section 5.1).
inline constexpr double kSameTimeSeconds = 1e-6;

/// What a clip's keyframes hold; None until the first one says.
enum class ClipType : std::uint8_t { None, Vertex, Skeletal };

/// A keyframe; its time stands in Clip::times_s at the same index.
struct Keyframe {
  KeyframeId id = 0;  ///< unique in its scene, never reused
  /// How it blends towards the next keyframe; empty: as the actor, then the clip says.
  std::optional<animation::Interpolation> interpolation;
  std::optional<animation::CubicBezier> easing;
  VertexKeyPtr vertices{};  ///< of a vertex clip; else null
  PoseKeyPtr pose{};        ///< of a skeletal clip; else null
  bool operator==(const Keyframe&) const = default;
};

/// What can be said of a clip beside its keyframes.
struct ClipSettings {
  bool closed = false;
  /// Seconds, beyond the last keyframe; empty: the clip ends with its last keyframe, a closed one a mean key spacing later.
  std::optional<double> duration_s;
  std::optional<animation::Interpolation> interpolation;
  bool operator==(const ClipSettings&) const = default;
};

/// A named instant of a clip.
struct Marker {
  KeyframeId id = 0;    ///< unique in its scene, never reused
  double time_s = 0.0;  ///< >= 0; beyond the clip's end it is never reached
  std::string name;
  bool operator==(const Marker&) const = default;
};
using MarkersPtr = std::shared_ptr<const std::vector<Marker>>;

/// How an imported track blends where its keyframes say nothing.
struct ChannelMode {
  animation::Channel channel;
  animation::Interpolation interpolation = animation::Interpolation::Linear;
  bool operator==(const ChannelMode&) const = default;
};
using ChannelModesPtr = std::shared_ptr<const std::vector<ChannelMode>>;

/// Named keyframes in ascending order of time. A value: held as shared_ptr<const Clip>, copied to be changed
/// (times and pointers, never vertices). A skeletal keyframe keys a part of the pose or all of it; what one channel's track is,
/// follows from all keyframes that key it.
struct Clip {
  std::string name;
  ClipSettings settings;
  ClipType declared_type = ClipType::None;  ///< by clip.create; keyframes say it better
  std::vector<double> times_s;              ///< ascending, at least kSameTimeSeconds apart, each >= 0
  std::vector<Keyframe> keyframes;          ///< one for each time
  ChannelModesPtr channel_modes;            ///< ascending by channel; null: none
  MarkersPtr markers;                       ///< ascending by time, then id; null: none

  /// What its keyframes hold; of an empty clip, what was declared.
  [[nodiscard]] ClipType type() const noexcept;
  /// Seconds; 0 for an empty clip.
  [[nodiscard]] double duration_s() const noexcept;
  /// Precondition: there is a keyframe.
  [[nodiscard]] animation::KeyTimeline timeline() const noexcept { return {times_s, duration_s(), settings.closed}; }
  [[nodiscard]] std::optional<std::size_t> index_of(KeyframeId id) const noexcept;
  /// Where a keyframe at `time_s` would stand.
  [[nodiscard]] std::size_t place_of(double time_s) const noexcept;
  /// What an imported track says of its keys; empty: nothing.
  [[nodiscard]] std::optional<animation::Interpolation> mode_of(const animation::Channel& channel) const noexcept;
  /// The keyframes of a skeletal clip as tracks; packed when first asked for, which takes time in proportion to all keyed
  /// values. Safe from any thread. Precondition: always the same skeleton, that of the actor.
  [[nodiscard]] const animation::TrackSet& tracks(const Skeleton& skeleton) const;

 private:
  Memo<animation::TrackSet> tracks_;
};

using ClipPtr = std::shared_ptr<const Clip>;

/// One clip without keyframes, `default`: what an actor starts with that brings none.
[[nodiscard]] std::vector<Clip> empty_clips();

}  // namespace tweend::model
