#pragma once

#include <cstddef>
#include <vector>

#include "server/stage/marker_crossings.hpp"
#include "server/stage/player.hpp"

namespace tweend::stage {

/// More crossings than these in one tick, of one player, and the rest is not told.
inline constexpr std::size_t kMostCrossings = 4'096;

/// A marker that was passed.
struct Passed {
  model::ClipPtr clip;
  std::size_t marker = 0;  ///< index into the clip's
  ClockUs at_us = 0;
};

/// What became of a player by itself.
struct Course {
  Player player;
  std::vector<Passed> passed;  ///< in order of time
  bool moved = false;          ///< to the next clip of its queue, or to its end
  bool ended = false;          ///< nothing is left to play
  ClockUs ended_us = 0;        ///< and when, if so
  bool cut = false;            ///< more markers were passed than are told
};

/// Lets a player run from one reading to a later one: through its queue to its end, past markers. Pure. Two courses over two
/// halves of a stretch are the course over the whole.
/// @param from_us  what happened up to there has been told
/// @param most  markers that are told; 0: nobody listens
[[nodiscard]] Course run_player(const model::Actor& actor, const Player& player, ClockUs from_us, ClockUs to_us,
                                std::size_t most);

/// The markers at which a player stood when it began to play, at its anchor.
[[nodiscard]] std::vector<Passed> markers_at_start(const model::Actor& actor, const Player& player);

/// The next reading at which a player passes a marker of the clip it is on; empty: none before its end.
[[nodiscard]] std::optional<ClockUs> next_marker_us(const model::Actor& actor, const Player& player, ClockUs after_us);

}  // namespace tweend::stage
