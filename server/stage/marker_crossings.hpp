#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "server/model/clip.hpp"
#include "server/stage/motion.hpp"

namespace tweend::stage {

// When a motion passes the markers of its clip, worked out from its law: nothing is sampled, and so nothing is missed however
// fast it runs.
//
// A motion is at a place of a lap: (lap, rest). A marker is passed where the motion's place reaches the marker's, in the
// direction it runs, and that counts for the place it comes to, not for the one it leaves: times in (from, to], backwards in
// [to, from). The two ends of a `repeat` are one instant and two places: a marker at `in` and one at `out` are both passed
// there, each once. A ping-pong turns at its ends, and is there once. Places are compared by the very numbers that make a later
// anchor (laps_of is exact), so that a crossing is neither lost nor told twice where a motion is changed on top of it.

/// A marker and the first reading at which the motion is at or past it.
struct Crossing {
  std::size_t marker = 0;  ///< index
  ClockUs at_us = 0;
  bool operator==(const Crossing&) const = default;
};

/// The crossings at readings after `from_us` up to `to_us`, in their order; at most `most`.
/// Only what comes after the anchor: the place where the motion began is start_crossings().
/// @return false: there are more
bool crossings(const Motion& motion, const PlayRange& r, std::span<const model::Marker> markers, ClockUs from_us, ClockUs to_us,
               std::size_t most, std::vector<Crossing>& out);

/// What a motion that begins to play at its anchor is on right there. One that has run a little since it began (the next clip
/// of a queue, between two microseconds) says where that was.
/// @param began_phase_s  the unfolded phase where it began; at its anchor or before
void start_crossings(const Motion& motion, const PlayRange& r, std::span<const model::Marker> markers, double began_phase_s,
                     std::size_t most, std::vector<Crossing>& out);

/// The first crossing after a reading; empty: none.
[[nodiscard]] std::optional<ClockUs> next_crossing_us(const Motion& motion, const PlayRange& r,
                                                      std::span<const model::Marker> markers, ClockUs after_us);

}  // namespace tweend::stage
