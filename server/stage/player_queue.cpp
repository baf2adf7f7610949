#include <algorithm>
#include <cmath>
#include <utility>

#include "server/stage/player.hpp"

// A queue is laps laid end to end: what runs past the end of one clip is where the next one already is. The carried rest, less
// than a microsecond of the clock, is why seams don't add up to a drift however many there are.

namespace tweend::stage {

void Player::start_queue(const model::Actor& a, std::vector<QueueEntry> entries, ClockUs now_us) {
  const Player before = *this;
  const PlayRange r = range_of(*clip_of(a, *this));
  leave_queue(r, now_us);
  rebase(r, now_us);  // spin and layers go on
  const QueueEntry first = entries.front();
  queue = Queue{std::make_shared<const std::vector<QueueEntry>>(std::move(entries)), 1, loop};
  enter(a, first, now_us, 0.0);
  jump();
  ++starts;
  if (first.fade_s > 0.0) fade_from(before, first.fade_s, now_us);
}

void Player::enter(const model::Actor& a, const QueueEntry& entry, ClockUs seam_us, double carry_s) {
  const std::int64_t wraps = anchor_wraps;
  clip = entry.clip;
  range.reset();
  const PlayRange r = range_of(*clip_of(a, *this));
  loop = entry.loop;
  laps = entry.repeat;
  playing = true;
  anchor_us = seam_us;
  anchor_phase_s = speed < 0.0 ? total_s(r) - carry_s : carry_s;
  // However many laps lie ahead, or behind a motion that runs them backwards: entering is no wrap.
  anchor_wraps += wraps - read(r, seam_us).wraps;
}

void Player::leave_queue(const PlayRange& r, ClockUs now_us) noexcept {
  if (!queue) return;
  const PlayerReading reading = read(r, now_us);
  rebase(r, now_us);
  const double forwards = reading.time_s - r.in_s;
  const bool returning = loop == Loop::PingPong && reading.backwards != (speed < 0.0);
  loop = queue->loop_after;
  anchor_phase_s = returning && loop == Loop::PingPong ? 2.0 * r.length_s() - forwards : forwards;
  anchor_wraps = reading.wraps;
  laps = 0;
  queue.reset();
}

bool Player::move_on(const model::Actor& a, ClockUs seam_us) {
  const PlayRange r = range_of(*clip_of(a, *this));
  const Motion was = *this;
  // Below 0 where more was carried into this clip than it is long.
  const double left_s = speed < 0.0 ? anchor_phase_s : total_s(r) - anchor_phase_s;
  const double carry_s = std::max(0.0, std::abs(speed) * seconds_between(anchor_us, seam_us) - left_s);
  const std::int64_t wraps = read(r, seam_us).wraps;
  rebase(r, seam_us);
  if (!queue) return false;
  while (queue->next < queue->entries->size()) {
    const QueueEntry& entry = (*queue->entries)[queue->next++];
    if (!a.find_clip(entry.clip)) continue;  // removed meanwhile
    anchor_wraps = wraps;
    enter(a, entry, seam_us, carry_s);
    ++starts;
    if (entry.fade_s > 0.0) {
      Player before = *this;
      static_cast<Motion&>(before) = was;
      if (before.loop != Loop::Once) before.laps = 0;  // it goes on around while it fades out
      fade_from(before, entry.fade_s, seam_us);
    } else {
      jump();
    }
    return true;
  }
  leave_queue(r, seam_us);
  return false;
}

bool Player::moves_on_by(const model::Actor& a, ClockUs at_us) const noexcept {
  if (!queue) return false;
  const auto seam = end_us(range_of(*clip_of(a, *this)));
  return seam && *seam <= at_us;
}

Player reached(const model::Actor& actor, Player player, ClockUs at_us) {
  while (player.moves_on_by(actor, at_us)) {
    if (!player.move_on(actor, *player.end_us(player.range_of(*clip_of(actor, player))))) break;
  }
  return player;
}

}  // namespace tweend::stage
