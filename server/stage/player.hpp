#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/base/clock.hpp"
#include "server/base/result.hpp"
#include "server/model/actor.hpp"

namespace tweend::stage {

enum class Loop : std::uint8_t { Once, Repeat, PingPong };

/// The stretch of a clip that is played, media seconds.
struct PlayRange {
  double in_s = 0.0;
  double out_s = 0.0;
  bool seamless = false;  ///< the whole of a closed clip: a `repeat` runs through its seam without a jump
  [[nodiscard]] double length_s() const noexcept { return out_s - in_s; }
  bool operator==(const PlayRange&) const = default;
};

/// What a clock reading shows of a player.
struct PlayerReading {
  double time_s = 0.0;     ///< media time within the range
  bool playing = false;    ///< false also once a `once` has run out, whether or not the stage has said so yet
  bool ended = false;      ///< a `once` that has run out while playing
  bool backwards = false;  ///< media time falls as the clock rises (negative speed, or a ping-pong's way back)
  std::int64_t wraps = 0;  ///< times a `repeat` has passed its seam
  double played_s = 0.0;   ///< clock seconds played: what spin turns by
};

/// The transport of one actor as a law of motion: an anchor on the steady clock, a phase there and a speed. A value: reading
/// it at any clock reading is a pure function, so nothing needs a tick for time to pass, and ticks can't make it drift.
///
/// The phase counts media seconds from the range's start, unfolded: a ping-pong of length L runs through 2 L.
struct Player {
  std::string actor;
  std::string clip;
  bool playing = false;
  double speed = 1.0;  ///< media seconds a clock second; negative: backwards
  Loop loop = Loop::Repeat;
  std::optional<PlayRange> range;  ///< empty: the whole clip, however it grows
  ClockUs anchor_us = 0;
  double anchor_phase_s = 0.0;
  double anchor_played_s = 0.0;
  std::int64_t anchor_wraps = 0;
  model::PoseKeyPtr live;   ///< a live pose over what the clips show; null: none
  std::uint64_t jumps = 0;  ///< seeks, stops, clip changes: breaks in what is shown

  bool operator==(const Player&) const = default;

  /// The range in force for a clip: the one that was set, cut to what the clip has; the whole clip where nothing is left.
  [[nodiscard]] PlayRange range_of(const model::Clip& c) const noexcept;
  [[nodiscard]] PlayerReading read(const PlayRange& r, ClockUs now_us) const noexcept;
  /// When a playing `once` runs out; empty: never.
  [[nodiscard]] std::optional<ClockUs> end_us(const PlayRange& r) const noexcept;

  // Each of these takes effect at the reading `now_us`; media time is continuous where nothing says otherwise.

  /// Moves the anchor to `now_us` without changing what is shown.
  void rebase(const PlayRange& r, ClockUs now_us) noexcept;
  /// A time outside the range is clamped for `once` and wrapped for the others; `out` itself can be sought.
  void seek(const PlayRange& r, double time_s, ClockUs now_us) noexcept;
  /// Starts again where a `once` has nothing left to play in the direction of its speed.
  void play(const PlayRange& r, ClockUs now_us) noexcept;
  void pause(const PlayRange& r, ClockUs now_us) noexcept;
  /// Pauses at the range's start; spin is 0 again.
  void stop(const PlayRange& r, ClockUs now_us) noexcept;
  /// Another clip of the actor, from its range's start (backwards: its end); the range is the whole clip again.
  void change_clip(const model::Clip& next, ClockUs now_us) noexcept;
  void set_speed(const PlayRange& r, double new_speed, ClockUs now_us) noexcept;
  void set_loop(const PlayRange& r, Loop new_loop, ClockUs now_us) noexcept;
  /// @param next  empty: the whole clip
  void set_range(const model::Clip& c, std::optional<PlayRange> next, ClockUs now_us) noexcept;
  /// The clip has changed under the player: keeps the media time where the new range has it.
  void follow(const PlayRange& before, const PlayRange& after, ClockUs now_us) noexcept;
};

/// The time of the n-th keyframe after (n > 0) or before (n < 0) `time_s` within the range; past the last one it stays there
/// (`once`) or goes on around. Empty where the range has no keyframe.
[[nodiscard]] std::optional<double> step_keyframes(std::span<const double> times_s, const PlayRange& r, Loop loop,
                                                   double time_s, std::int64_t n) noexcept;

}  // namespace tweend::stage
