#include "server/stage/marker_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tweend::stage {
namespace {

/// A marker's place in every lap.
struct Station {
  double rest = 0.0;
  std::size_t marker = 0;
};

bool before(const Lap& a, const Lap& b) noexcept { return a.whole != b.whole ? a.whole < b.whole : a.rest < b.rest; }

/// Walks along the stations of a motion, in the order it comes to them.
class Walk {
 public:
  Walk(const Motion& motion, const PlayRange& r, std::span<const model::Marker> markers) : motion_(motion), range_(r) {
    const double length = r.length_s();
    for (std::size_t i = 0; i < markers.size(); ++i) {
      const double time_s = markers[i].time_s;
      if (!(time_s >= r.in_s && time_s <= r.out_s)) continue;
      const double forwards = time_s == r.out_s ? length : time_s - r.in_s;
      stations_.push_back({forwards, i});
      // A ping-pong passes it again on its way back, but turns at its ends.
      if (motion.loop == Loop::PingPong && forwards > 0.0 && forwards < length)
        stations_.push_back({2.0 * length - forwards, i});
    }
    std::sort(stations_.begin(), stations_.end(),
              [](const Station& a, const Station& b) { return a.rest != b.rest ? a.rest < b.rest : a.marker < b.marker; });
  }

  /// Where the motion is; at a seam the end of the lap it comes from, as far as order goes.
  [[nodiscard]] Lap place(ClockUs at_us) const noexcept {
    const Lap at = motion_.lap_at(range_, at_us);
    const double lap = motion_.lap_s(range_);
    if (forwards()) return at.rest < lap ? at : Lap{at.whole + 1.0, 0.0};
    return at.rest > 0.0 ? at : Lap{at.whole - 1.0, lap};
  }
  [[nodiscard]] bool reached(const Lap& station, const Lap& place) const noexcept {
    return forwards() ? !before(place, station) : !before(station, place);
  }

  /// Stands before the first station beyond a place, or at it.
  void stand(const Lap& place, bool and_at_it) noexcept {
    lap_ = place.whole;
    const auto below = [](const Station& s, double rest) { return s.rest < rest; };
    const auto above = [](double rest, const Station& s) { return rest < s.rest; };
    // The first station at the place, or the first after it: forwards the next, backwards just past the next.
    const bool at = and_at_it == forwards();
    const auto it = at ? std::lower_bound(stations_.begin(), stations_.end(), place.rest, below)
                       : std::upper_bound(stations_.begin(), stations_.end(), place.rest, above);
    next_ = it - stations_.begin();
    if (!forwards()) --next_;
    wrap();
  }
  void step() noexcept {
    next_ += forwards() ? 1 : -1;
    wrap();
  }
  /// Whether there is a station ahead.
  [[nodiscard]] bool ahead() const noexcept {
    if (stations_.empty()) return false;
    const auto bound = static_cast<double>(motion_.bound());
    return bound == 0.0 || (forwards() ? lap_ <= bound : lap_ >= 0.0);
  }
  [[nodiscard]] Lap station() const noexcept { return {lap_, stations_[static_cast<std::size_t>(next_)].rest}; }
  [[nodiscard]] std::size_t marker() const noexcept { return stations_[static_cast<std::size_t>(next_)].marker; }
  /// Whether a bounded motion comes by: past its last lap only a ping-pong does, which ends where it began.
  [[nodiscard]] bool counts() const noexcept {
    const auto bound = static_cast<double>(motion_.bound());
    if (bound == 0.0) return true;
    if (lap_ >= 0.0 && lap_ < bound) return true;
    return motion_.loop == Loop::PingPong && lap_ == bound && station().rest == 0.0;
  }

  /// The first reading at or past the station. By formula, then put right: rounding may be a microsecond off.
  [[nodiscard]] ClockUs reading() const noexcept {
    const Lap s = station();
    const double phase = s.whole * motion_.lap_s(range_) + s.rest;
    const double clock_us = (phase - motion_.anchor_phase_s) / motion_.speed * 1e6;
    constexpr double kNever = 9e15;  // centuries
    if (!(clock_us < kNever)) return std::numeric_limits<ClockUs>::max();
    ClockUs at = motion_.anchor_us + static_cast<ClockUs>(std::ceil(std::max(clock_us, 0.0)));
    constexpr int kTries = 4;
    for (int i = 0; i < kTries && at > motion_.anchor_us && reached(s, place(at - 1)); ++i) --at;
    for (int i = 0; i < kTries && !reached(s, place(at)); ++i) ++at;
    return at;
  }

 private:
  [[nodiscard]] bool forwards() const noexcept { return motion_.speed > 0.0; }
  void wrap() noexcept {
    const auto count = static_cast<std::ptrdiff_t>(stations_.size());
    if (next_ >= count) {
      next_ = 0;
      ++lap_;
    } else if (next_ < 0) {
      next_ = count - 1;
      --lap_;
    }
  }

  const Motion& motion_;
  const PlayRange& range_;
  std::vector<Station> stations_;
  double lap_ = 0.0;
  std::ptrdiff_t next_ = 0;
};

}  // namespace

bool crossings(const Motion& motion, const PlayRange& r, std::span<const model::Marker> markers, ClockUs from_us, ClockUs to_us,
               std::size_t most, std::vector<Crossing>& out) {
  from_us = std::max(from_us, motion.anchor_us);
  if (markers.empty() || !motion.runs(r) || to_us <= from_us) return true;
  Walk walk(motion, r, markers);
  const Lap to = walk.place(to_us);
  std::size_t found = 0;
  for (walk.stand(walk.place(from_us), false); walk.ahead() && walk.reached(walk.station(), to); walk.step()) {
    if (!walk.counts()) continue;
    if (found++ == most) return false;
    out.push_back({walk.marker(), std::clamp(walk.reading(), from_us + 1, to_us)});
  }
  return true;
}

void start_crossings(const Motion& motion, const PlayRange& r, std::span<const model::Marker> markers, double began_phase_s,
                     std::size_t most, std::vector<Crossing>& out) {
  if (markers.empty()) return;
  Walk walk(motion, r, markers);
  const double lap = motion.lap_s(r);
  if (!motion.runs(r)) {  // it is where it is
    const double time_s = motion.read(r, motion.anchor_us).time_s;
    for (std::size_t i = 0; i < markers.size() && out.size() < most; ++i) {
      if (markers[i].time_s == time_s) out.push_back({i, motion.anchor_us});
    }
    return;
  }
  // A held place may be the very end of a lap.
  Lap began = began_phase_s >= 0.0 && began_phase_s <= lap ? Lap{0.0, began_phase_s} : laps_of(began_phase_s, lap);
  if (motion.bound() > 0 && began_phase_s >= motion.total_s(r)) began = {static_cast<double>(motion.bound()) - 1.0, lap};
  const Lap to = walk.place(motion.anchor_us);
  for (walk.stand(began, true); walk.ahead() && walk.reached(walk.station(), to) && out.size() < most; walk.step()) {
    if (walk.counts()) out.push_back({walk.marker(), motion.anchor_us});
  }
}

std::optional<ClockUs> next_crossing_us(const Motion& motion, const PlayRange& r, std::span<const model::Marker> markers,
                                        ClockUs after_us) {
  if (markers.empty() || !motion.runs(r)) return std::nullopt;
  const ClockUs from_us = std::max(after_us, motion.anchor_us);
  Walk walk(motion, r, markers);
  for (walk.stand(walk.place(from_us), false); walk.ahead(); walk.step()) {
    if (!walk.counts()) continue;
    const ClockUs at = walk.reading();
    if (at == std::numeric_limits<ClockUs>::max()) return std::nullopt;
    return std::max(at, from_us + 1);
  }
  return std::nullopt;
}

}  // namespace tweend::stage
