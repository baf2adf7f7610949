#include "server/stage/marker_crossings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "server/stage/course.hpp"
#include "tests/stage/players.hpp"

// Crossings are worked out from the law of motion. Here a playhead walks instead, reading by reading or from one marker to the
// next, and both must have passed the same markers.

namespace tweend::stage {
namespace {

using Markers = std::vector<model::Marker>;

Markers markers_at(std::initializer_list<double> times_s) {
  Markers markers;
  for (const double t : times_s) markers.push_back({static_cast<model::KeyframeId>(markers.size() + 1), t, "m"});
  return markers;
}

Motion running(Loop loop, double speed, double phase_s, std::int64_t laps = 0) {
  Motion motion;
  motion.loop = loop;
  motion.speed = speed;
  motion.laps = laps;
  motion.playing = true;
  motion.anchor_phase_s = phase_s;
  return motion;
}

std::vector<Crossing> crossed(const Motion& m, const PlayRange& r, const Markers& markers, ClockUs from_us, ClockUs to_us) {
  std::vector<Crossing> out;
  EXPECT_TRUE(crossings(m, r, markers, from_us, to_us, 1'000'000, out));
  return out;
}

std::vector<Crossing> at_start(const Motion& m, const PlayRange& r, const Markers& markers) {
  std::vector<Crossing> out;
  start_crossings(m, r, markers, m.anchor_phase_s, 1'000, out);
  return out;
}

std::vector<ClockUs> readings(const std::vector<Crossing>& list) {
  std::vector<ClockUs> at;
  for (const Crossing& c : list) at.push_back(c.at_us);
  return at;
}

std::vector<std::size_t> which(const std::vector<Crossing>& list) {
  std::vector<std::size_t> markers;
  for (const Crossing& c : list) markers.push_back(c.marker);
  return markers;
}

using Readings = std::vector<ClockUs>;
using Which = std::vector<std::size_t>;

TEST(Crossings, AreNoneOfWhatStandsStill) {
  const Markers markers = markers_at({0.0, 1.0, 2.0});
  Motion paused = running(Loop::Repeat, 1.0, 0.0);
  paused.playing = false;
  EXPECT_TRUE(crossed(paused, kTwoSeconds, markers, 0, 10 * kSecond).empty());
  EXPECT_TRUE(crossed(running(Loop::Repeat, 0.0, 0.0), kTwoSeconds, markers, 0, 10 * kSecond).empty());
  EXPECT_TRUE(crossed(running(Loop::Repeat, 1.0, 0.0), PlayRange{}, markers, 0, 10 * kSecond).empty());
  EXPECT_FALSE(next_crossing_us(paused, kTwoSeconds, markers, 0));
}

TEST(Crossings, AreNoneOutsideOfTheRange) {
  const PlayRange range{0.5, 1.5};
  EXPECT_TRUE(crossed(running(Loop::Repeat, 1.0, 0.0), range, markers_at({0.25, 1.75}), 0, 10 * kSecond).empty());
}

TEST(Crossings, ComeOnceAPassEitherWay) {
  const Markers markers = markers_at({0.5});
  EXPECT_EQ(readings(crossed(running(Loop::Repeat, 1.0, 0.0), kTwoSeconds, markers, 0, 5 * kSecond)),
            (Readings{500'000, 2'500'000, 4'500'000}));
  EXPECT_EQ(readings(crossed(running(Loop::Repeat, -1.0, 2.0), kTwoSeconds, markers, 0, 5 * kSecond)),
            (Readings{1'500'000, 3'500'000}));
  EXPECT_EQ(readings(crossed(running(Loop::PingPong, 1.0, 0.0), kTwoSeconds, markers, 0, 5 * kSecond)),
            (Readings{500'000, 3'500'000, 4'500'000}));
  EXPECT_EQ(readings(crossed(running(Loop::Once, 1.0, 0.0), kTwoSeconds, markers, 0, 5 * kSecond)), (Readings{500'000}));
}

TEST(Crossings, OfTheIntervalsEndsHaveTheLaterOne) {
  const Markers markers = markers_at({0.5});
  const Motion m = running(Loop::Repeat, 1.0, 0.0);
  EXPECT_EQ(crossed(m, kTwoSeconds, markers, 0, 500'000).size(), 1U);
  EXPECT_TRUE(crossed(m, kTwoSeconds, markers, 0, 499'999).empty());
  EXPECT_TRUE(crossed(m, kTwoSeconds, markers, 500'000, 2'499'999).empty());
}

TEST(Crossings, AtTheSeamOfARepeatHaveBothOfItsEnds) {
  const Markers markers = markers_at({0.0, 2.0});
  const auto forwards = crossed(running(Loop::Repeat, 1.0, 0.0), kTwoSeconds, markers, 0, 5 * kSecond);
  EXPECT_EQ(which(forwards), (Which{1, 0, 1, 0})) << "the end, then the beginning";
  EXPECT_EQ(readings(forwards), (Readings{2'000'000, 2'000'000, 4'000'000, 4'000'000}));
  const auto backwards = crossed(running(Loop::Repeat, -1.0, 2.0), kTwoSeconds, markers, 0, 5 * kSecond);
  EXPECT_EQ(which(backwards), (Which{0, 1, 0, 1}));
  EXPECT_EQ(readings(backwards), (Readings{2'000'000, 2'000'000, 4'000'000, 4'000'000}));
}

TEST(Crossings, WhereAPingPongTurnsComeOnce) {
  const Markers markers = markers_at({0.0, 2.0});
  for (const double speed : {1.0, -1.0}) {
    const auto found = crossed(running(Loop::PingPong, speed, 1.0), kTwoSeconds, markers, 0, 8 * kSecond);
    EXPECT_EQ(which(found), speed > 0.0 ? (Which{1, 0, 1, 0}) : (Which{0, 1, 0, 1}));
    EXPECT_EQ(readings(found), (Readings{1'000'000, 3'000'000, 5'000'000, 7'000'000}));
  }
}

TEST(Crossings, HaveTheEndOfWhatEndsButNotTheBeginningBehindIt) {
  const Markers markers = markers_at({0.0, 2.0});
  EXPECT_EQ(which(crossed(running(Loop::Once, 1.0, 0.0), kTwoSeconds, markers, 0, 9 * kSecond)), (Which{1}));
  EXPECT_EQ(which(crossed(running(Loop::Once, -1.0, 2.0), kTwoSeconds, markers, 0, 9 * kSecond)), (Which{0}));
  EXPECT_EQ(which(crossed(running(Loop::Repeat, 1.0, 0.0, 2), kTwoSeconds, markers, 0, 9 * kSecond)), (Which{1, 0, 1}));
  EXPECT_EQ(which(crossed(running(Loop::Repeat, -1.0, 4.0, 2), kTwoSeconds, markers, 0, 9 * kSecond)), (Which{0, 1, 0}));
  EXPECT_EQ(which(crossed(running(Loop::PingPong, 1.0, 0.0, 1), kTwoSeconds, markers, 0, 9 * kSecond)), (Which{1, 0}));
  EXPECT_EQ(which(crossed(running(Loop::PingPong, -1.0, 4.0, 1), kTwoSeconds, markers, 0, 9 * kSecond)), (Which{1, 0}));
}

TEST(Crossings, ComeManyTimesATick) {
  const Markers markers = markers_at({0.5});
  const auto found = crossed(running(Loop::Repeat, 2000.0, 0.0), kTwoSeconds, markers, 0, 16'667);
  ASSERT_EQ(found.size(), 17U);
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_EQ(found[k].at_us, 250 + 1'000 * static_cast<ClockUs>(k));
}

TEST(Crossings, AreBoundedHoweverFast) {
  std::vector<Crossing> out;
  EXPECT_FALSE(crossings(running(Loop::Repeat, 1e12, 0.0), kTwoSeconds, markers_at({0.5}), 0, kSecond, 100, out));
  EXPECT_EQ(out.size(), 100U);
  out.clear();
  for (const double speed : {1e100, -1e100, 1e308, -1e308}) {  // beyond what can be counted
    static_cast<void>(crossings(running(Loop::Repeat, speed, 0.0), kTwoSeconds, markers_at({0.5}), 0, kSecond, 100, out));
    EXPECT_LE(out.size(), 100U);
    static_cast<void>(next_crossing_us(running(Loop::Repeat, speed, 0.0), kTwoSeconds, markers_at({0.5}), kSecond));
    out.clear();
  }
}

TEST(StartCrossings, AreWhereItStands) {
  const Markers markers = markers_at({0.0, 0.5, 2.0});
  EXPECT_EQ(which(at_start(running(Loop::Repeat, 1.0, 0.5), kTwoSeconds, markers)), (Which{1}));
  EXPECT_EQ(which(at_start(running(Loop::Repeat, -1.0, 0.5), kTwoSeconds, markers)), (Which{1}));
  EXPECT_EQ(which(at_start(running(Loop::Repeat, 0.0, 0.5), kTwoSeconds, markers)), (Which{1}));
  EXPECT_EQ(which(at_start(running(Loop::PingPong, 1.0, 3.5), kTwoSeconds, markers)), (Which{1})) << "on its way back";
  EXPECT_TRUE(at_start(running(Loop::Repeat, 1.0, 0.6), kTwoSeconds, markers).empty());
}

TEST(StartCrossings, AtAnEndAreThoseItIsOnAndThoseItRunsOver) {
  const Markers markers = markers_at({0.0, 2.0});
  EXPECT_EQ(which(at_start(running(Loop::Repeat, 1.0, 0.0), kTwoSeconds, markers)), (Which{0}));
  EXPECT_EQ(which(at_start(running(Loop::Repeat, -1.0, 2.0), kTwoSeconds, markers)), (Which{1}));
  EXPECT_EQ(which(at_start(running(Loop::Repeat, 1.0, 2.0), kTwoSeconds, markers)), (Which{1, 0}))
      << "held at out, then around";
  EXPECT_EQ(which(at_start(running(Loop::Repeat, -1.0, 0.0), kTwoSeconds, markers)), (Which{0, 1}));
  EXPECT_EQ(which(at_start(running(Loop::Once, 1.0, 0.0), kTwoSeconds, markers)), (Which{0}));
  EXPECT_EQ(which(at_start(running(Loop::Once, -1.0, 2.0), kTwoSeconds, markers)), (Which{1}));
  EXPECT_EQ(which(at_start(running(Loop::PingPong, 1.0, 0.0), kTwoSeconds, markers)), (Which{0}));
  EXPECT_EQ(which(at_start(running(Loop::PingPong, -1.0, 0.0), kTwoSeconds, markers)), (Which{0}));
}

/// Dyadic numbers, so that a walk in plain arithmetic is exact and there is no doubt about which side of an interval's end a
/// crossing is on.
class Eighths {
 public:
  explicit Eighths(std::uint32_t seed) : random_(seed) {}
  int pick(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  double eighths(int low, int high) { return pick(low, high) / 8.0; }
  template <class T>
  T one_of(std::initializer_list<T> list) {
    return *(list.begin() + pick(0, static_cast<int>(list.size()) - 1));
  }

 private:
  std::mt19937 random_;
};

/// A playhead in eighths of a second that takes one step at a time, and what it steps on.
struct Stepper {
  int length = 0;  ///< eighths
  Loop loop = Loop::Repeat;
  int direction = 1;
  int at = 0;
  std::int64_t laps = 0;  ///< 0: no end
  int half = 0;           ///< of a ping-pong: which way it goes
  bool ended = false;

  [[nodiscard]] int way() const { return loop == Loop::PingPong && half == 1 ? -direction : direction; }
  /// The places it comes to with one step: at a repeat's seam two.
  std::vector<int> step() {
    if (ended) return {};
    if (at == (way() > 0 ? length : 0)) {  // where it cannot go on: only at first
      if (loop == Loop::Once) return {};
      if (loop == Loop::Repeat) at = length - at;
      if (loop == Loop::PingPong) half = 1 - half;
    }
    const int way = this->way();
    at += way;
    std::vector<int> places{at};
    const bool edge = at == 0 || at == length;
    if (!edge || at == (way > 0 ? 0 : length)) return places;
    if (loop == Loop::PingPong) {
      half = 1 - half;
      if (half == 0 && laps > 0 && --laps == 0) ended = true;
      return places;
    }
    if (loop == Loop::Once || (laps > 0 && --laps == 0)) {
      ended = true;
      return places;
    }
    places.push_back(way > 0 ? 0 : length);
    at = places.back();
    return places;
  }
};

TEST(Crossings, AreThoseOfAWalk) {
  Eighths random(7);
  for (int run = 0; run < 3'000; ++run) {
    Stepper walk;
    walk.length = random.pick(1, 24);
    walk.loop = random.one_of({Loop::Once, Loop::Repeat, Loop::PingPong});
    walk.direction = random.one_of({1, -1});
    if (walk.loop == Loop::Repeat && random.pick(0, 1) == 0) walk.laps = random.pick(1, 3);
    if (walk.loop == Loop::PingPong && random.pick(0, 1) == 0) walk.laps = random.pick(1, 3);
    const bool bounded = walk.laps > 0;
    // A bounded one begins at its beginning, the others anywhere.
    walk.at = bounded ? (walk.direction > 0 || walk.loop == Loop::PingPong ? 0 : walk.length) : random.pick(0, walk.length);
    const double in_s = random.eighths(0, 16);
    const PlayRange range{in_s, in_s + walk.length / 8.0};
    const double lap_s = (walk.loop == Loop::PingPong ? 2.0 : 1.0) * range.length_s();
    double phase = walk.at / 8.0;
    if (bounded && walk.direction < 0) phase = lap_s * static_cast<double>(walk.laps);
    // A ping-pong that goes backwards from a place of its way up comes down first, and then turns.
    const double speed = walk.direction * std::ldexp(1.0, random.pick(-2, 3));
    Motion motion = running(walk.loop, speed, phase, walk.laps);
    motion.anchor_us = random.pick(0, 1'000);
    if (walk.loop == Loop::PingPong && walk.direction < 0 && bounded) walk.direction = 1;  // its places are the same either way

    Markers markers;
    for (int m = 0, count = random.pick(1, 4); m < count; ++m) {
      markers.push_back({m, in_s + random.pick(-2, walk.length + 2) / 8.0, "m"});
    }
    std::sort(markers.begin(), markers.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });

    const int steps = random.pick(1, 80);
    const double step_us = 125'000.0 / std::abs(speed);
    std::vector<Crossing> wanted;
    for (int s = 1; s <= steps; ++s) {
      const auto at = motion.anchor_us + static_cast<ClockUs>(s * step_us);
      for (const int place : walk.step()) {
        for (std::size_t m = 0; m < markers.size(); ++m) {
          if (markers[m].time_s == in_s + place / 8.0) wanted.push_back({m, at});
        }
      }
    }
    const ClockUs to_us = motion.anchor_us + static_cast<ClockUs>(steps * step_us);
    auto found = crossed(motion, range, markers, motion.anchor_us, to_us);
    // Markers of one place have no order.
    const auto order = [](const Crossing& a, const Crossing& b) {
      return a.at_us != b.at_us ? a.at_us < b.at_us : a.marker < b.marker;
    };
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.at_us < b.at_us; }));
    std::sort(found.begin(), found.end(), order);
    std::sort(wanted.begin(), wanted.end(), order);
    ASSERT_EQ(found, wanted) << "run " << run << ": loop " << static_cast<int>(walk.loop) << ", length " << walk.length
                             << ", speed " << speed << ", laps " << motion.laps << ", phase " << phase;
    const auto next = next_crossing_us(motion, range, markers, motion.anchor_us);
    if (!wanted.empty()) {
      ASSERT_TRUE(next);
      EXPECT_EQ(*next, wanted.front().at_us);
    }
  }
}

/// Any numbers: here the parts of a stretch must have what the whole has.
TEST(Crossings, OfPartsAreThoseOfTheWhole) {
  std::mt19937 random(11);
  const auto uniform = [&random](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int run = 0; run < 2'000; ++run) {
    const double in_s = uniform(0.0, 3.0);
    const PlayRange range{in_s, in_s + uniform(0.01, 3.0)};
    const Loop loop = kLoops[run % 3];
    const double speed = uniform(-1.0, 1.0) * std::pow(10.0, uniform(-1.0, 3.0));
    const std::int64_t laps = run % 2 == 0 ? 0 : 1 + run % 5;
    Motion motion = running(loop, speed, 0.0, laps);
    motion.anchor_phase_s = uniform(0.0, motion.bound() > 0 ? motion.total_s(range) : motion.lap_s(range));
    motion.anchor_us = 123;
    Markers markers = markers_at({in_s, range.out_s});
    for (int m = 0; m < 3; ++m) markers.push_back({m + 10, uniform(in_s, range.out_s), "m"});
    std::sort(markers.begin(), markers.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });

    const ClockUs to_us = motion.anchor_us + static_cast<ClockUs>(uniform(1.0, 20.0 / std::abs(speed)) * 1e6);
    const auto whole = crossed(motion, range, markers, 0, to_us);
    std::vector<Crossing> parts;
    for (ClockUs at = 0; at < to_us;) {
      // Often right before or at a crossing, where a mistake would be.
      const auto ahead = next_crossing_us(motion, range, markers, at);
      ClockUs next = at + 1 + static_cast<ClockUs>(uniform(0.0, static_cast<double>(to_us) / 7.0));
      if (ahead && uniform(0.0, 1.0) < 0.5) next = std::max(at + 1, *ahead - (uniform(0.0, 1.0) < 0.5 ? 1 : 0));
      next = std::min(next, to_us);
      for (const Crossing& c : crossed(motion, range, markers, at, next)) parts.push_back(c);
      at = next;
    }
    ASSERT_EQ(parts, whole) << "run " << run << ": loop " << static_cast<int>(loop) << ", speed " << speed;
  }
}

/// Changing the speed, pausing and going on neither loses a crossing nor tells it twice: as many as a count over the whole way.
TEST(Crossings, SurviveChangesOnTopOfThem) {
  std::mt19937 random(5);
  const auto uniform = [&random](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int run = 0; run < 500; ++run) {
    const double in_s = uniform(0.0, 3.0);
    const PlayRange range{in_s, in_s + uniform(0.1, 2.0)};
    const Markers markers = markers_at({in_s + uniform(0.2, 0.8) * range.length_s()});
    const Loop loop = run % 2 == 0 ? Loop::Repeat : Loop::PingPong;
    const double sign = run % 4 < 2 ? 1.0 : -1.0;
    Motion motion = running(loop, sign, 0.0);
    double way = 0.0;  // the whole of it, media seconds
    std::size_t count = 0;
    ClockUs now = 0;
    for (int change = 0; change < 40; ++change) {
      motion.speed = sign * uniform(0.1, 20.0);
      const auto ahead = next_crossing_us(motion, range, markers, now);
      const ClockUs next =
          ahead && change % 2 == 0 ? *ahead - (change % 4 == 0 ? 1 : 0) : now + static_cast<ClockUs>(uniform(1.0, 4e5));
      if (next <= now) continue;
      count += crossed(motion, range, markers, now, next).size();
      way += std::abs(motion.speed) * seconds_between(now, next);
      motion.rebase(range, next);
      now = next;
    }
    const double length = range.length_s();
    const double first = sign > 0.0 ? markers[0].time_s - in_s : range.out_s - markers[0].time_s;
    double expected = 0.0;
    if (loop == Loop::Repeat) {
      expected = std::floor((way - first) / length) + 1.0;
    } else {
      const double up = markers[0].time_s - in_s;  // from 0 it goes up either way: folding mirrors a negative phase
      expected = std::floor((way - up) / (2.0 * length)) + 1.0 + std::floor((way - (2.0 * length - up)) / (2.0 * length)) + 1.0;
    }
    EXPECT_NEAR(static_cast<double>(count), expected, 1.0) << "run " << run;  // the last one may be a rounding away
  }
}

TEST(Crossings, AgreeWithTheReading) {
  std::mt19937 random(3);
  const auto uniform = [&random](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int run = 0; run < 500; ++run) {
    const PlayRange range{0.0, uniform(0.1, 2.0)};
    Motion motion = running(kLoops[run % 3], uniform(-50.0, 50.0), uniform(0.0, range.out_s));
    const Markers markers = markers_at({uniform(0.0, range.out_s)});
    for (const Crossing& c : crossed(motion, range, markers, 0, kSecond)) {
      const double off = std::abs(motion.read(range, c.at_us).time_s - markers[0].time_s);
      const double step_s = std::abs(motion.speed) * 1e-6 * (1.0 + 1e-6) + 1e-12;
      EXPECT_LE(std::min(off, range.length_s() - off), step_s);
    }
  }
}

}  // namespace
}  // namespace tweend::stage
