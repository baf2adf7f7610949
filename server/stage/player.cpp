#include "server/stage/player.hpp"

#include <algorithm>
#include <cmath>

namespace tweend::stage {
namespace {

// Like std::fmod, but in [0, length) also for negative x.
double wrapped(double x, double length) noexcept {
  const double m = std::fmod(x, length);
  const double positive = m < 0.0 ? m + length : m;
  return positive < length ? positive : 0.0;  // rounding may land on the length itself
}

double clamped_or_wrapped(const PlayRange& r, Loop loop, double time_s) noexcept {
  if (time_s >= r.in_s && time_s <= r.out_s) return time_s;
  if (loop == Loop::Once || r.length_s() <= 0.0) return std::clamp(time_s, r.in_s, r.out_s);
  return r.in_s + wrapped(time_s - r.in_s, r.length_s());
}

}  // namespace

PlayRange Player::range_of(const model::Clip& c) const noexcept {
  const PlayRange whole{0.0, c.duration_s()};
  if (!range) return whole;
  const PlayRange cut{range->in_s, std::min(range->out_s, whole.out_s)};
  return cut.in_s < cut.out_s ? cut : whole;
}

PlayerReading Player::read(const PlayRange& r, ClockUs now_us) const noexcept {
  PlayerReading reading;
  const double length = r.length_s();
  const double ran_s = playing ? seconds_between(anchor_us, now_us) : 0.0;
  const double phase = anchor_phase_s + speed * ran_s;
  reading.playing = playing;
  reading.backwards = speed < 0.0;
  reading.wraps = anchor_wraps;
  reading.played_s = anchor_played_s + ran_s;
  const bool still = !playing || length <= 0.0;
  if (loop == Loop::Once) {
    reading.time_s = r.in_s + std::clamp(phase, 0.0, std::max(length, 0.0));
    const auto end = end_us(r);
    reading.ended = end && now_us >= *end;
    if (reading.ended) {
      reading.playing = false;
      reading.time_s = speed < 0.0 ? r.in_s : r.out_s;  // exactly, whatever the clock's last microsecond
      reading.played_s = anchor_played_s + seconds_between(anchor_us, *end);
    }
  } else if (loop == Loop::PingPong) {
    const double folded = still ? phase : wrapped(phase, 2.0 * length);
    const bool returning = folded > length;
    reading.time_s = r.in_s + std::clamp(returning ? 2.0 * length - folded : folded, 0.0, std::max(length, 0.0));
    reading.backwards = returning != (speed < 0.0);
  } else {
    // A held time may be `out`; a running one is there for no time at all.
    reading.time_s = r.in_s + (still || ran_s == 0.0 ? std::clamp(phase, 0.0, std::max(length, 0.0)) : wrapped(phase, length));
    if (!still) reading.wraps += static_cast<std::int64_t>(std::floor(phase / length));
  }
  return reading;
}

std::optional<ClockUs> Player::end_us(const PlayRange& r) const noexcept {
  if (!playing || loop != Loop::Once) return std::nullopt;
  if (r.length_s() <= 0.0) return anchor_us;
  if (speed == 0.0) return std::nullopt;
  const double left_s = speed > 0.0 ? r.length_s() - anchor_phase_s : anchor_phase_s;
  const double clock_us = std::max(0.0, left_s) / std::abs(speed) * 1e6;
  if (clock_us > 9e15) return std::nullopt;  // centuries: beyond what the clock can hold
  return anchor_us + static_cast<ClockUs>(std::ceil(clock_us));
}

void Player::rebase(const PlayRange& r, ClockUs now_us) noexcept {
  const PlayerReading reading = read(r, now_us);
  const double forwards = reading.time_s - r.in_s;
  const bool returning = loop == Loop::PingPong && reading.backwards != (speed < 0.0);
  anchor_phase_s = returning ? 2.0 * r.length_s() - forwards : forwards;
  anchor_played_s = reading.played_s;
  anchor_wraps = reading.wraps;
  anchor_us = now_us;
  playing = reading.playing;
}

void Player::seek(const PlayRange& r, double time_s, ClockUs now_us) noexcept {
  const PlayerReading reading = read(r, now_us);
  rebase(r, now_us);
  const double forwards = clamped_or_wrapped(r, loop, time_s) - r.in_s;
  // A ping-pong on its way back stays on it.
  const bool returning = loop == Loop::PingPong && reading.backwards != (speed < 0.0);
  anchor_phase_s = returning ? 2.0 * r.length_s() - forwards : forwards;
  ++jumps;
}

void Player::play(const PlayRange& r, ClockUs now_us) noexcept {
  rebase(r, now_us);
  const double length = r.length_s();
  if (loop == Loop::Once && (speed < 0.0 ? anchor_phase_s <= 0.0 : anchor_phase_s >= length)) {
    anchor_phase_s = speed < 0.0 ? length : 0.0;
    ++jumps;
  }
  playing = true;
}

void Player::pause(const PlayRange& r, ClockUs now_us) noexcept {
  rebase(r, now_us);
  playing = false;
}

void Player::stop(const PlayRange& r, ClockUs now_us) noexcept {
  pause(r, now_us);
  anchor_phase_s = 0.0;
  anchor_played_s = 0.0;
  ++jumps;
}

void Player::change_clip(const model::Clip& next, ClockUs now_us) noexcept {
  clip = next.name;
  range.reset();
  anchor_us = now_us;
  anchor_phase_s = speed < 0.0 ? next.duration_s() : 0.0;
  ++jumps;
}

void Player::set_speed(const PlayRange& r, double new_speed, ClockUs now_us) noexcept {
  rebase(r, now_us);
  speed = new_speed;
}

void Player::set_loop(const PlayRange& r, Loop new_loop, ClockUs now_us) noexcept {
  rebase(r, now_us);
  if (new_loop == loop) return;
  if (loop == Loop::PingPong && anchor_phase_s > r.length_s()) anchor_phase_s = 2.0 * r.length_s() - anchor_phase_s;
  loop = new_loop;
}

void Player::set_range(const model::Clip& c, std::optional<PlayRange> next, ClockUs now_us) noexcept {
  const PlayRange before = range_of(c);
  const double time_s = read(before, now_us).time_s;
  rebase(before, now_us);
  range = next;
  const PlayRange after = range_of(c);
  if (after == before) return;
  const double kept = clamped_or_wrapped(after, loop, time_s);
  anchor_phase_s = kept - after.in_s;
  if (kept != time_s) ++jumps;
}

void Player::follow(const PlayRange& before, const PlayRange& after, ClockUs now_us) noexcept {
  if (before == after) return;
  const PlayerReading reading = read(before, now_us);
  rebase(before, now_us);
  const double forwards = clamped_or_wrapped(after, loop, reading.time_s) - after.in_s;
  const bool returning = loop == Loop::PingPong && reading.backwards != (speed < 0.0);
  anchor_phase_s = returning ? 2.0 * after.length_s() - forwards : forwards;
}

std::optional<double> step_keyframes(std::span<const double> times_s, const PlayRange& r, Loop loop, double time_s,
                                     std::int64_t n) noexcept {
  const auto begin = std::lower_bound(times_s.begin(), times_s.end(), r.in_s);
  const auto end = std::upper_bound(begin, times_s.end(), r.out_s);
  const auto count = static_cast<std::int64_t>(end - begin);
  if (count == 0) return std::nullopt;
  if (n == 0) return time_s;
  const auto here = n > 0 ? std::upper_bound(begin, end, time_s) : std::lower_bound(begin, end, time_s);
  // The first key after the playhead is step 1, the last one before it step -1.
  const std::int64_t target = (here - begin) + (n > 0 ? n - 1 : n);
  const std::int64_t index =
      loop == Loop::Once ? std::clamp<std::int64_t>(target, 0, count - 1) : ((target % count) + count) % count;
  return begin[index];
}

}  // namespace tweend::stage
