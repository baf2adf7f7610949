#include "server/stage/player.hpp"

#include <algorithm>
#include <cmath>

namespace tweend::stage {
namespace {

/// A phase as whole lengths and a rest in [0, length).
struct Laps {
  double whole;
  double rest;
};

Laps laps_of(double phase, double length) noexcept {
  constexpr double kUncounted = 1e15;  // so far out, neither laps nor places on them can be told apart
  if (!(std::abs(phase) < kUncounted * length)) return {0.0, 0.0};
  double rest = std::fmod(phase, length);  // exact
  if (rest < 0.0) rest += length;
  const double whole = std::round((phase - rest) / length);
  // Just before a seam, rounding lands on it.
  return rest < length ? Laps{whole, rest} : Laps{whole + 1.0, 0.0};
}

double clamped_or_wrapped(const PlayRange& r, Loop loop, double time_s) noexcept {
  if (time_s >= r.in_s && time_s <= r.out_s) return time_s;
  if (loop == Loop::Once || r.length_s() <= 0.0) return std::clamp(time_s, r.in_s, r.out_s);
  return std::min(r.in_s + laps_of(time_s - r.in_s, r.length_s()).rest, r.out_s);
}

}  // namespace

PlayRange Player::range_of(const model::Clip& c) const noexcept {
  const PlayRange whole{0.0, c.duration_s(), c.settings.closed};
  if (!range) return whole;
  const PlayRange cut{range->in_s, std::min(range->out_s, whole.out_s)};
  if (!(cut.in_s < cut.out_s)) return whole;
  return cut.in_s == 0.0 && cut.out_s == whole.out_s ? whole : cut;
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
  const bool still = !playing || length <= 0.0 || speed == 0.0 || ran_s == 0.0;
  double forwards = std::clamp(phase, 0.0, std::max(length, 0.0));  // where time stands still, and of a `once`
  if (loop == Loop::Once) {
    const auto end = end_us(r);
    reading.ended = end && now_us >= *end;
    if (reading.ended) {
      reading.playing = false;
      forwards = speed < 0.0 ? 0.0 : length;  // exactly, whatever the clock's last microsecond
      reading.played_s = anchor_played_s + seconds_between(anchor_us, *end);
    }
  } else if (loop == Loop::PingPong) {
    const double folded = still ? phase : laps_of(phase, 2.0 * length).rest;
    const bool returning = folded > length;
    forwards = std::clamp(returning ? 2.0 * length - folded : folded, 0.0, std::max(length, 0.0));
    reading.backwards = returning != (speed < 0.0);
  } else if (!still) {
    // A held time may be `out`; a running one is there for no time at all.
    const Laps laps = laps_of(phase, length);
    forwards = laps.rest;
    if (!r.seamless) reading.wraps += static_cast<std::int64_t>(laps.whole);
  }
  reading.time_s = forwards == length ? r.out_s : std::min(r.in_s + forwards, r.out_s);
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
