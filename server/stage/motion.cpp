#include "server/stage/motion.hpp"

#include <algorithm>
#include <cmath>

namespace tweend::stage {

Lap laps_of(double phase, double length) noexcept {
  constexpr double kUncounted = 1e15;  // so far out, neither laps nor places on them can be told apart
  if (!(std::abs(phase) < kUncounted * length)) return {};
  double rest = std::fmod(phase, length);  // exact
  if (rest < 0.0) rest += length;
  const double whole = std::round((phase - rest) / length);
  // Just before a seam, rounding lands on it.
  return rest < length ? Lap{whole, rest} : Lap{whole + 1.0, 0.0};
}

double clamped_or_wrapped(const PlayRange& r, Loop loop, double time_s) noexcept {
  if (time_s >= r.in_s && time_s <= r.out_s) return time_s;
  if (loop == Loop::Once || r.length_s() <= 0.0) return std::clamp(time_s, r.in_s, r.out_s);
  return std::min(r.in_s + laps_of(time_s - r.in_s, r.length_s()).rest, r.out_s);
}

namespace {

/// Whole seconds apart from the rest, and divided last: what is even comes out even, after microseconds and after years.
double media_seconds(double speed, ClockUs clock_us) noexcept {
  constexpr ClockUs kSecond = 1'000'000;
  return speed * static_cast<double>(clock_us / kSecond) + speed * static_cast<double>(clock_us % kSecond) / 1e6;
}

}  // namespace

PlayRange Motion::range_of(const model::Clip& c) const noexcept {
  const PlayRange whole{0.0, c.duration_s(), c.settings.closed};
  if (!range) return whole;
  const PlayRange cut{range->in_s, std::min(range->out_s, whole.out_s)};
  if (!(cut.in_s < cut.out_s)) return whole;
  return cut.in_s == 0.0 && cut.out_s == whole.out_s ? whole : cut;
}

std::optional<ClockUs> Motion::end_us(const PlayRange& r) const noexcept {
  if (!playing || bound() == 0) return std::nullopt;
  if (r.length_s() <= 0.0) return anchor_us;
  if (speed == 0.0) return std::nullopt;
  const double left_s = speed > 0.0 ? total_s(r) - anchor_phase_s : anchor_phase_s;
  const double clock_us = std::max(0.0, left_s) / std::abs(speed) * 1e6;
  if (clock_us > 9e15) return std::nullopt;  // centuries: beyond what the clock can hold
  return anchor_us + static_cast<ClockUs>(std::ceil(clock_us));
}

double Motion::phase_at(const PlayRange& r, ClockUs now_us) const noexcept {
  const double phase = anchor_phase_s + (playing ? media_seconds(speed, now_us - anchor_us) : 0.0);
  if (bound() == 0) return phase;
  const double total = std::max(total_s(r), 0.0);
  const auto end = end_us(r);
  if (end && now_us >= *end) return speed < 0.0 ? 0.0 : total;  // exactly, whatever the clock's last microsecond
  return std::clamp(phase, 0.0, total);
}

Lap Motion::lap_at(const PlayRange& r, ClockUs now_us) const noexcept {
  const double phase = phase_at(r, now_us);
  const double lap = lap_s(r);
  if (lap <= 0.0) return {};
  if (bound() == 0) {
    // A held time may be `out`; a running one is there for no time at all.
    const bool still = !runs(r) || now_us == anchor_us;
    return still ? Lap{0.0, std::clamp(phase, 0.0, lap)} : laps_of(phase, lap);
  }
  const double last = static_cast<double>(bound()) - 1.0;
  if (phase >= total_s(r)) return {last, lap};
  const Lap at = laps_of(phase, lap);
  return at.whole <= last ? at : Lap{last, lap};
}

PlayerReading Motion::read(const PlayRange& r, ClockUs now_us) const noexcept {
  PlayerReading reading;
  const double length = std::max(r.length_s(), 0.0);
  const auto end = end_us(r);
  reading.ended = end && now_us >= *end;
  reading.playing = playing && !reading.ended;
  const double ran_s = playing ? seconds_between(anchor_us, reading.ended ? *end : now_us) : 0.0;
  reading.played_s = anchor_played_s + ran_s;
  const Lap lap = lap_at(r, now_us);
  const bool returning = loop == Loop::PingPong && lap.rest > length;
  const double forwards = std::clamp(returning ? 2.0 * length - lap.rest : lap.rest, 0.0, length);
  reading.time_s = forwards == length ? r.out_s : std::min(r.in_s + forwards, r.out_s);
  reading.backwards = returning != (speed < 0.0);
  reading.wraps = anchor_wraps;
  if (loop != Loop::PingPong && !r.seamless) reading.wraps += static_cast<std::int64_t>(lap.whole);
  // Of a bounded motion what it really has run; the clock's last microsecond is none of it.
  reading.run_s = anchor_run_s + (bound() > 0 && runs(r) ? phase_at(r, now_us) - anchor_phase_s : speed * ran_s);
  return reading;
}

void Motion::rebase(const PlayRange& r, ClockUs now_us) noexcept {
  const PlayerReading reading = read(r, now_us);
  if (bound() > 0) {
    anchor_phase_s = phase_at(r, now_us);  // its laps go on being counted
  } else {
    anchor_phase_s = lap_at(r, now_us).rest;
    anchor_wraps = reading.wraps;
  }
  anchor_played_s = reading.played_s;
  anchor_run_s = reading.run_s;
  anchor_us = now_us;
  playing = reading.playing;
}

void Motion::follow(const PlayRange& before, const PlayRange& after, ClockUs now_us) noexcept {
  if (before == after) return;
  const PlayerReading reading = read(before, now_us);
  const Lap lap = lap_at(before, now_us);
  rebase(before, now_us);
  const double forwards = clamped_or_wrapped(after, bound() > 0 ? Loop::Once : loop, reading.time_s) - after.in_s;
  const bool returning = loop == Loop::PingPong && reading.backwards != (speed < 0.0);
  anchor_phase_s = returning ? 2.0 * after.length_s() - forwards : forwards;
  if (bound() > 0) anchor_phase_s += lap.whole * lap_s(after);
}

}  // namespace tweend::stage
