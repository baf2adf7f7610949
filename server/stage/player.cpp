#include "server/stage/player.hpp"

#include <algorithm>
#include <cmath>

namespace tweend::stage {

// A break in what is shown is a break of what fades as well.
void Player::jump() noexcept {
  ++jumps;
  fades.clear();
}

void Player::seek(const PlayRange& r, double time_s, ClockUs now_us) noexcept {
  leave_queue(r, now_us);
  const PlayerReading reading = read(r, now_us);
  rebase(r, now_us);
  const double kept_s = clamped_or_wrapped(r, loop, time_s);
  const double forwards = kept_s - r.in_s;
  // A ping-pong on its way back stays on it.
  const bool returning = loop == Loop::PingPong && reading.backwards != (speed < 0.0);
  anchor_phase_s = returning ? 2.0 * r.length_s() - forwards : forwards;
  anchor_run_s = kept_s;
  jump();
}

void Player::play(const PlayRange& r, ClockUs now_us) noexcept {
  const bool was_playing = read(r, now_us).playing;
  rebase(r, now_us);
  const double length = r.length_s();
  if (!queue && loop == Loop::Once && (speed < 0.0 ? anchor_phase_s <= 0.0 : anchor_phase_s >= length)) {
    anchor_phase_s = speed < 0.0 ? length : 0.0;
    anchor_run_s = r.in_s + anchor_phase_s;
    jump();
  }
  if (!was_playing) ++starts;
  playing = true;
}

void Player::pause(const PlayRange& r, ClockUs now_us) noexcept {
  rebase(r, now_us);
  playing = false;
}

void Player::stop(const PlayRange& r, ClockUs now_us) noexcept {
  leave_queue(r, now_us);
  pause(r, now_us);
  anchor_phase_s = 0.0;
  anchor_played_s = 0.0;
  anchor_run_s = r.in_s;
  jump();
}

void Player::change_clip(const model::Clip& next, ClockUs now_us) noexcept {
  if (queue) loop = queue->loop_after;
  queue.reset();
  laps = 0;
  clip = next.name;
  range.reset();
  anchor_us = now_us;
  anchor_phase_s = speed < 0.0 ? next.duration_s() : 0.0;
  jump();
}

void Player::set_speed(const PlayRange& r, double new_speed, ClockUs now_us) noexcept {
  rebase(r, now_us);
  speed = new_speed;
}

void Player::set_loop(const PlayRange& r, Loop new_loop, ClockUs now_us) noexcept {
  leave_queue(r, now_us);
  rebase(r, now_us);
  if (new_loop == loop) return;
  if (loop == Loop::PingPong && anchor_phase_s > r.length_s()) anchor_phase_s = 2.0 * r.length_s() - anchor_phase_s;
  loop = new_loop;
}

void Player::set_range(const model::Clip& c, std::optional<PlayRange> next, ClockUs now_us) noexcept {
  const PlayRange before = range_of(c);
  leave_queue(before, now_us);
  const double time_s = read(before, now_us).time_s;
  rebase(before, now_us);
  range = next;
  const PlayRange after = range_of(c);
  if (after == before) return;
  const double kept = clamped_or_wrapped(after, loop, time_s);
  anchor_phase_s = kept - after.in_s;
  if (kept == time_s) return;
  anchor_run_s = kept;
  jump();
}

model::ClipPtr clip_of(const model::Actor& actor, const Motion& motion) noexcept {
  const model::ClipPtr clip = actor.find_clip(motion.clip);
  return clip ? clip : actor.clips.front();
}

std::optional<double> step_keyframes(std::span<const double> times_s, const PlayRange& r, Loop loop, double time_s,
                                     std::int64_t n) noexcept {
  const auto begin = std::lower_bound(times_s.begin(), times_s.end(), r.in_s);
  const auto end = std::upper_bound(begin, times_s.end(), r.out_s);
  const auto count = static_cast<std::int64_t>(end - begin);
  if (count == 0) return std::nullopt;
  if (n == 0) return time_s;
  // A playhead on a keyframe may be a rounding away from it; no two keyframes are as near as that.
  constexpr double kOnIt = model::kSameTimeSeconds / 2.0;
  const auto here = n > 0 ? std::upper_bound(begin, end, time_s + kOnIt) : std::lower_bound(begin, end, time_s - kOnIt);
  // The first key after the playhead is step 1, the last one before it step -1.
  const std::int64_t target = (here - begin) + (n > 0 ? n - 1 : n);
  const std::int64_t index =
      loop == Loop::Once ? std::clamp<std::int64_t>(target, 0, count - 1) : ((target % count) + count) % count;
  return begin[index];
}

}  // namespace tweend::stage
