#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "server/base/clock.hpp"
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
  bool playing = false;    ///< false also once a bounded motion has run out, whether or not the stage has said so yet
  bool ended = false;      ///< one that has run out while playing
  bool backwards = false;  ///< media time falls as the clock rises (negative speed, or a ping-pong's way back)
  std::int64_t wraps = 0;  ///< times the seam of an open clip was passed
  double played_s = 0.0;   ///< clock seconds played: what spin turns by
  double run_s = 0.0;      ///< media seconds run, not folded by the loop: what layers go by
};

/// A place on the way: whole laps and a rest. Running forwards the rest of a running motion is in [0, lap), backwards too;
/// a held one may be at the lap's very end.
struct Lap {
  double whole = 0.0;
  double rest = 0.0;
};

/// Whole lengths and a rest in [0, length) of a phase. Exact in the rest, and so the same wherever it is asked for.
[[nodiscard]] Lap laps_of(double phase, double length) noexcept;

/// One clip's law of motion: an anchor on the steady clock, a phase there and a speed. A value: reading it at any clock reading
/// is a pure function, so nothing needs a tick for time to pass, and ticks can't make it drift.
///
/// The phase counts media seconds from the range's start, unfolded: a lap of a ping-pong of length L is 2 L, there and back.
struct Motion {
  std::string clip;
  bool playing = false;
  double speed = 1.0;  ///< media seconds a clock second; negative: backwards
  Loop loop = Loop::Repeat;
  std::int64_t laps = 0;           ///< how many to run; 0: as `loop` says, one of `once` and no end of the others
  std::optional<PlayRange> range;  ///< empty: the whole clip, however it grows
  ClockUs anchor_us = 0;
  double anchor_phase_s = 0.0;
  double anchor_played_s = 0.0;
  double anchor_run_s = 0.0;
  std::int64_t anchor_wraps = 0;

  bool operator==(const Motion&) const = default;

  /// The range in force for a clip: the one that was set, cut to what the clip has; the whole clip where nothing is left.
  [[nodiscard]] PlayRange range_of(const model::Clip& c) const noexcept;
  [[nodiscard]] PlayerReading read(const PlayRange& r, ClockUs now_us) const noexcept;
  /// When it runs out, if it is playing and has a bound; empty: never.
  [[nodiscard]] std::optional<ClockUs> end_us(const PlayRange& r) const noexcept;

  /// Moves the anchor to `now_us` without changing what is shown.
  void rebase(const PlayRange& r, ClockUs now_us) noexcept;
  /// The clip has changed under the player: keeps the media time where the new range has it.
  void follow(const PlayRange& before, const PlayRange& after, ClockUs now_us) noexcept;

  [[nodiscard]] double lap_s(const PlayRange& r) const noexcept { return (loop == Loop::PingPong ? 2.0 : 1.0) * r.length_s(); }
  /// Laps after which it ends; 0: never.
  [[nodiscard]] std::int64_t bound() const noexcept { return laps > 0 ? laps : loop == Loop::Once ? 1 : 0; }
  /// The phase at its end, running forwards.
  [[nodiscard]] double total_s(const PlayRange& r) const noexcept { return static_cast<double>(bound()) * lap_s(r); }
  [[nodiscard]] bool runs(const PlayRange& r) const noexcept { return playing && speed != 0.0 && r.length_s() > 0.0; }
  /// The unfolded phase; of a bounded motion from 0 to total_s().
  [[nodiscard]] double phase_at(const PlayRange& r, ClockUs now_us) const noexcept;
  /// The same, folded; of an unbounded motion that stands still as it was set.
  [[nodiscard]] Lap lap_at(const PlayRange& r, ClockUs now_us) const noexcept;
};

/// `time_s` where the range has it; else clamped (`once`) or wrapped (the others).
[[nodiscard]] double clamped_or_wrapped(const PlayRange& r, Loop loop, double time_s) noexcept;

}  // namespace tweend::stage
