#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>

#include "server/stage/player.hpp"
#include "tests/support/scenes.hpp"

// The player answers any reading with a formula. Here a playhead walks instead, from one end of the range to the other, and
// both must always be at the same place.

namespace tweend::stage {
namespace {

struct Walker {
  PlayRange range;
  Loop loop = Loop::Repeat;
  double speed = 1.0;
  bool playing = false;
  bool returning = false;  ///< on a ping-pong's way back
  long double time_s = 0.0L;
  long double played_s = 0.0L;
  std::int64_t wraps = 0;

  [[nodiscard]] bool rises() const { return (speed >= 0.0) != returning; }

  void walk(long double clock_s) {
    if (!playing) return;
    const long double pace = std::abs(static_cast<long double>(speed));
    long double left = pace * clock_s;
    for (;;) {
      const bool up = rises();
      const long double room = up ? range.out_s - time_s : time_s - range.in_s;
      if (loop == Loop::Once && pace > 0.0L && left >= room) {
        played_s += room / pace;
        time_s = up ? range.out_s : range.in_s;
        playing = false;
        return;
      }
      if (left <= room) {
        time_s += up ? left : -left;
        played_s += clock_s;
        return;
      }
      left -= room;
      time_s = up ? range.out_s : range.in_s;
      if (loop == Loop::PingPong) {
        returning = !returning;
      } else {
        time_s = up ? range.in_s : range.out_s;
        wraps += up ? 1 : -1;
      }
    }
  }

  void seek(double to_s) {
    if (to_s < range.in_s || to_s > range.out_s) {
      if (loop == Loop::Once) {
        to_s = std::clamp(to_s, range.in_s, range.out_s);
      } else {
        while (to_s < range.in_s) to_s += range.length_s();
        while (to_s > range.out_s) to_s -= range.length_s();
      }
    }
    time_s = to_s;
  }
  void play() {
    if (loop == Loop::Once && (speed < 0.0 ? time_s <= range.in_s : time_s >= range.out_s)) {
      time_s = speed < 0.0 ? range.out_s : range.in_s;
    }
    playing = true;
  }
  void stop() {
    playing = returning = false;
    time_s = range.in_s;
    played_s = 0.0L;
  }
  void set_loop(Loop next) {
    if (next != loop) returning = false;
    loop = next;
  }
};

class PlayerAndWalker {
 public:
  explicit PlayerAndWalker(std::uint32_t seed) : random_(seed) {
    clip_ = clip_of_length(uniform(0.05, 10.0));
    player_.clip = clip_.name;
    player_.anchor_us = now_us_;
    walker_.range = player_.range_of(clip_);
  }

  void take_steps(int steps) {
    for (int i = 0; i < steps && !::testing::Test::HasFatalFailure(); ++i) {
      advance();
      act();
      compare(walker_, now_us_);
    }
  }

 private:
  static model::Clip clip_of_length(double length_s) {
    model::Clip clip;
    clip.name = "clip";
    clip.settings.duration_s = length_s;
    return clip;
  }
  double uniform(double from, double to) { return std::uniform_real_distribution(from, to)(random_); }
  int one_of(int choices) { return std::uniform_int_distribution(0, choices - 1)(random_); }
  double any_speed() {
    const double sign = one_of(2) == 0 ? -1.0 : 1.0;
    switch (one_of(4)) {
      case 0:
        return sign;
      case 1:
        return one_of(3) == 0 ? 0.0 : sign * uniform(0.01, 4.0);
      default:
        return sign * std::pow(10.0, uniform(-3.0, 3.0));
    }
  }
  [[nodiscard]] PlayRange range() const { return player_.range_of(clip_); }

  void advance() {
    const auto ahead_us = static_cast<ClockUs>(std::pow(10.0, uniform(0.0, 6.7)));
    for (int i = 0; i < 4; ++i) {  // readings on the way change nothing
      const auto part_us = static_cast<ClockUs>(uniform(0.0, static_cast<double>(ahead_us)));
      Walker there = walker_;
      there.walk(static_cast<long double>(part_us) * 1e-6L);
      compare(there, now_us_ + part_us);
    }
    now_us_ += ahead_us;
    walker_.walk(static_cast<long double>(ahead_us) * 1e-6L);
  }

  void act() {
    const PlayRange r = range();
    switch (one_of(11)) {
      case 0:
      case 1:
      case 2:
        player_.play(r, now_us_);
        walker_.play();
        break;
      case 3:
        player_.pause(r, now_us_);
        walker_.playing = false;
        break;
      case 4: {
        const double to_s = uniform(r.in_s - 3.0 * r.length_s(), r.out_s + 3.0 * r.length_s());
        player_.seek(r, to_s, now_us_);
        walker_.seek(to_s);
        break;
      }
      case 5: {
        const double speed = any_speed();
        player_.set_speed(r, speed, now_us_);
        walker_.speed = speed;
        break;
      }
      case 6:
      case 7: {
        const auto loop = static_cast<Loop>(one_of(3));
        player_.set_loop(r, loop, now_us_);
        walker_.set_loop(loop);
        break;
      }
      case 8:
        if (one_of(4) == 0) {
          player_.stop(r, now_us_);
          walker_.stop();
        } else {
          player_.rebase(r, now_us_);
        }
        break;
      case 9:
        change_range();
        break;
      default:
        change_clip_length();
    }
  }

  void change_range() {
    std::optional<PlayRange> next;
    if (one_of(3) != 0) {
      const double in_s = uniform(0.0, 0.8 * clip_.duration_s());
      next = PlayRange{in_s, uniform(in_s + 0.01, clip_.duration_s() + 0.02)};
    }
    player_.set_range(clip_, next, now_us_);
    walker_.range = range();
    walker_.seek(static_cast<double>(walker_.time_s));
    walker_.returning = player_.loop == Loop::PingPong && player_.read(range(), now_us_).backwards == (player_.speed >= 0.0);
  }

  void change_clip_length() {
    const PlayRange before = range();
    clip_ = clip_of_length(uniform(0.05, 10.0));
    player_.follow(before, range(), now_us_);
    walker_.range = range();
    walker_.seek(static_cast<double>(walker_.time_s));
  }

  void compare(const Walker& expected, ClockUs at_us) {
    const PlayRange r = range();
    const PlayerReading reading = player_.read(r, at_us);
    SCOPED_TRACE(::testing::Message() << "loop " << static_cast<int>(player_.loop) << ", speed " << player_.speed << ", range "
                                      << r.in_s << " to " << r.out_s << ", at " << at_us << " us");
    constexpr double kRounding = 1e-12;
    ASSERT_GE(reading.time_s, r.in_s - kRounding);
    ASSERT_LE(reading.time_s, r.out_s + kRounding);
    // At a seam the two may stand on different sides: where they are together with their wraps is the same place.
    const auto laps_ahead = static_cast<double>(reading.wraps - expected.wraps);
    ASSERT_NEAR(laps_ahead * r.length_s() + reading.time_s, static_cast<double>(expected.time_s), 1e-6);
    ASSERT_NEAR(reading.played_s, static_cast<double>(expected.played_s), 1e-5);
    const auto end = player_.end_us(r);
    if (end && std::abs(*end - at_us) <= 1) return;  // the walker ends between two readings of the clock
    ASSERT_EQ(reading.playing, expected.playing);
  }

  std::mt19937 random_;
  model::Clip clip_;
  Player player_;
  Walker walker_;
  ClockUs now_us_ = 1'000'000'000;
};

TEST(PlayerAgainstAWalker, IsAlwaysAtTheSamePlace) {
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    PlayerAndWalker both(seed);
    both.take_steps(120);
    if (HasFatalFailure()) return;
  }
}

// Whole seconds, whole speeds: all arithmetic is exact, also after years at great speed.
TEST(PlayerAgainstIntegers, FoldsHugeDistancesExactly) {
  std::mt19937_64 random(5);
  const auto one_of = [&](std::int64_t from, std::int64_t to) { return std::uniform_int_distribution(from, to)(random); };
  for (int i = 0; i < 20'000; ++i) {
    const std::int64_t length = one_of(1, 1000);
    const std::int64_t in = one_of(0, 1000);
    const std::int64_t begin = one_of(0, length - 1);
    const std::int64_t speed = one_of(-1'000'000, 1'000'000);
    const std::int64_t clock_s = one_of(1, 1'000'000'000);
    const PlayRange range{static_cast<double>(in), static_cast<double>(in + length)};
    const auto played = [&](Loop loop) {
      Player player;
      player.loop = loop;
      player.speed = static_cast<double>(speed);
      player.seek(range, static_cast<double>(in + begin), 0);
      player.play(range, 0);
      return player.read(range, clock_s * 1'000'000).time_s;
    };
    const std::int64_t phase = begin + speed * clock_s;
    const auto modulo = [&](std::int64_t m) { return ((phase % m) + m) % m; };
    if (std::abs(phase) > (std::int64_t{1} << 52)) continue;  // beyond what a double counts one by one
    EXPECT_EQ(played(Loop::Repeat), static_cast<double>(in + modulo(length)));
    const std::int64_t folded = modulo(2 * length);
    EXPECT_EQ(played(Loop::PingPong), static_cast<double>(in + std::min(folded, 2 * length - folded)));
    // Backwards from the start a `once` has nothing to play and starts at the end.
    const std::int64_t first = speed < 0 && begin == 0 ? length : begin;
    EXPECT_EQ(played(Loop::Once), static_cast<double>(in + std::clamp<std::int64_t>(first + speed * clock_s, 0, length)));
  }
}

}  // namespace
}  // namespace tweend::stage
