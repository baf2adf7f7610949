#include "server/stage/course.hpp"

namespace tweend::stage {
namespace {

std::span<const model::Marker> markers_of(const model::Clip& clip) noexcept {
  return clip.markers ? std::span<const model::Marker>(*clip.markers) : std::span<const model::Marker>();
}

void append(std::vector<Passed>& to, const model::ClipPtr& clip, const std::vector<Crossing>& crossed) {
  for (const Crossing& c : crossed) to.push_back({clip, c.marker, c.at_us});
}

}  // namespace

Course run_player(const model::Actor& actor, const Player& player, ClockUs from_us, ClockUs to_us, std::size_t most) {
  Course course{player, {}, false, false, 0, false};
  std::vector<Crossing> crossed;
  for (;;) {
    const model::ClipPtr clip = clip_of(actor, course.player);
    const PlayRange range = course.player.range_of(*clip);
    const auto end = course.player.end_us(range);
    const bool ends = end && *end <= to_us;
    const std::size_t room = most - course.passed.size();
    if (room > 0) {
      crossed.clear();
      course.cut |= !crossings(course.player, range, markers_of(*clip), from_us, ends ? *end : to_us, room, crossed);
      append(course.passed, clip, crossed);
    }
    if (!ends) return course;
    course.moved = true;
    if (!course.player.move_on(actor, *end)) {
      course.ended = true;
      course.ended_us = *end;
      return course;
    }
    from_us = *end;
    if (most == 0) continue;
    const model::ClipPtr next = clip_of(actor, course.player);
    const PlayRange over = course.player.range_of(*next);
    crossed.clear();
    start_crossings(course.player, over, markers_of(*next), course.player.speed < 0.0 ? course.player.total_s(over) : 0.0,
                    most - course.passed.size(), crossed);
    append(course.passed, next, crossed);
  }
}

std::vector<Passed> markers_at_start(const model::Actor& actor, const Player& player) {
  const model::ClipPtr clip = clip_of(actor, player);
  std::vector<Crossing> crossed;
  start_crossings(player, player.range_of(*clip), markers_of(*clip), player.anchor_phase_s, kMostCrossings, crossed);
  std::vector<Passed> passed;
  append(passed, clip, crossed);
  return passed;
}

std::optional<ClockUs> next_marker_us(const model::Actor& actor, const Player& player, ClockUs after_us) {
  if (!player.playing) return std::nullopt;
  const model::ClipPtr clip = clip_of(actor, player);
  return next_crossing_us(player, player.range_of(*clip), markers_of(*clip), after_us);
}

}  // namespace tweend::stage
