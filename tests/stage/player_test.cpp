#include "server/stage/player.hpp"

#include <gtest/gtest.h>

#include "tests/stage/players.hpp"
#include "tests/support/scenes.hpp"

namespace tweend::stage {
namespace {

TEST(Player, StartsPausedAtZeroAtItsOwnPaceAndRepeats) {
  const Player player;
  EXPECT_FALSE(player.playing);
  EXPECT_EQ(player.speed, 1.0);
  EXPECT_EQ(player.loop, Loop::Repeat);
  EXPECT_FALSE(player.range);
  EXPECT_EQ(player.read(kTwoSeconds, 0).time_s, 0.0);
  EXPECT_EQ(player.read(kTwoSeconds, 1000 * kSecond).time_s, 0.0);
}

TEST(Player, ReadsTheSameAtTheSameReadingHoweverOftenItIsRead) {
  const Player player = playing(Loop::PingPong, 0.7, kTwoSeconds);
  const double once_s = player.read(kTwoSeconds, 12'345'678).time_s;
  for (ClockUs at_us = 0; at_us < 100 * kSecond; at_us += 333'333) static_cast<void>(player.read(kTwoSeconds, at_us));
  EXPECT_EQ(player.read(kTwoSeconds, 12'345'678).time_s, once_s);
}

TEST(Player, HoldsItsTimeWhilePausedAndGoesOnFromThere) {
  for (const Loop loop : kLoops) {
    Player player = playing(loop, 1.0, kTwoSeconds);
    player.pause(kTwoSeconds, 500'000);
    EXPECT_DOUBLE_EQ(player.read(kTwoSeconds, 90 * kSecond).time_s, 0.5);
    EXPECT_FALSE(player.read(kTwoSeconds, 90 * kSecond).playing);
    player.play(kTwoSeconds, 90 * kSecond);
    EXPECT_DOUBLE_EQ(player.read(kTwoSeconds, 91 * kSecond).time_s, 1.5);
  }
}

TEST(Player, KeepsItsTimeAtTheReadingOfAnyChangeThatIsNoSeek) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-5.0, 5.0);
  std::uniform_int_distribution<ClockUs> later(1, 20 * kSecond);
  for (int i = 0; i < 3000; ++i) {
    const Loop loop = kLoops[i % 3];
    const Player before = playing(loop, any(random), kTwoSeconds);
    const ClockUs at_us = later(random);
    const double time_s = before.read(kTwoSeconds, at_us).time_s;
    const auto expect_kept = [&](const Player& after) { EXPECT_NEAR(after.read(kTwoSeconds, at_us).time_s, time_s, 1e-12); };
    Player player = before;
    player.rebase(kTwoSeconds, at_us);
    expect_kept(player);
    EXPECT_NEAR(player.read(kTwoSeconds, at_us + kSecond).time_s, before.read(kTwoSeconds, at_us + kSecond).time_s, 1e-9);
    player = before;
    player.set_speed(kTwoSeconds, any(random), at_us);
    expect_kept(player);
    player = before;
    player.set_loop(kTwoSeconds, kLoops[(i / 3) % 3], at_us);
    expect_kept(player);
    player = before;
    player.pause(kTwoSeconds, at_us);
    expect_kept(player);
    player = before;
    player.follow(kTwoSeconds, {0.0, 3.0}, at_us);
    EXPECT_NEAR(player.read({0.0, 3.0}, at_us).time_s, time_s, 1e-12);
    if (before.read(kTwoSeconds, at_us).ended) continue;
    player = before;
    player.play(kTwoSeconds, at_us);  // it plays already
    expect_kept(player);
  }
}

TEST(Player, GoesOnInThePingPongsDirectionAfterARebase) {
  const Player before = playing(Loop::PingPong, 1.0, kTwoSeconds);
  Player player = before;
  for (ClockUs at_us = 0; at_us < 9 * kSecond; at_us += 170'000) {
    player.rebase(kTwoSeconds, at_us);
    EXPECT_NEAR(player.read(kTwoSeconds, at_us + 50'000).time_s, before.read(kTwoSeconds, at_us + 50'000).time_s, 1e-9);
    EXPECT_EQ(player.read(kTwoSeconds, at_us).backwards, before.read(kTwoSeconds, at_us).backwards);
  }
}

TEST(Player, TellsTheDirectionOfItsTime) {
  const Player forth = playing(Loop::PingPong, 1.0, kTwoSeconds);
  EXPECT_FALSE(forth.read(kTwoSeconds, kSecond).backwards);
  EXPECT_TRUE(forth.read(kTwoSeconds, 3 * kSecond).backwards);
  EXPECT_FALSE(forth.read(kTwoSeconds, 5 * kSecond).backwards);
  const Player back = playing(Loop::PingPong, -1.0, kTwoSeconds);
  EXPECT_TRUE(back.read(kTwoSeconds, kSecond).backwards);
  EXPECT_FALSE(back.read(kTwoSeconds, 3 * kSecond).backwards);
  EXPECT_TRUE(playing(Loop::Repeat, -1.0, kTwoSeconds).read(kTwoSeconds, kSecond).backwards);
  EXPECT_FALSE(playing(Loop::Repeat, 1.0, kTwoSeconds).read(kTwoSeconds, 3 * kSecond).backwards);
}

TEST(Player, EndsAtTheFirstReadingAtWhichNothingIsLeft) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0.0, 4.0);
  std::uniform_real_distribution<double> power(-2.0, 2.0);
  for (int i = 0; i < 5000; ++i) {
    const double in_s = any(random);
    const PlayRange range{in_s, in_s + 0.01 + any(random)};
    const double speed = (i % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, power(random));
    const ClockUs from_us = 1'000'000'000 + i;
    const Player player = playing(Loop::Once, speed, range, from_us);
    const auto end_us = player.end_us(range);
    ASSERT_TRUE(end_us);
    EXPECT_NEAR(static_cast<double>(*end_us - from_us), range.length_s() / std::abs(speed) * 1e6, 1.001);
    EXPECT_GE(static_cast<double>(*end_us - from_us), range.length_s() / std::abs(speed) * 1e6 * (1.0 - 1e-12));

    const PlayerReading before = player.read(range, *end_us - 1);
    EXPECT_FALSE(before.ended);
    EXPECT_TRUE(before.playing);
    for (const ClockUs after_us : {ClockUs{0}, ClockUs{1}, 1000 * kSecond}) {
      const PlayerReading reading = player.read(range, *end_us + after_us);
      EXPECT_TRUE(reading.ended);
      EXPECT_FALSE(reading.playing);
      EXPECT_EQ(reading.time_s, speed > 0.0 ? range.out_s : range.in_s);
      EXPECT_DOUBLE_EQ(reading.played_s, seconds_between(from_us, *end_us));
    }
  }
}

TEST(Player, EndsAtTheSameReadingHoweverOftenItWasRebased) {
  const PlayRange range{0.25, 7.5};
  Player player = playing(Loop::Once, 1.0, range);
  const ClockUs end_us = *player.end_us(range);
  EXPECT_EQ(end_us, 7'250'000);
  for (ClockUs at_us = 0; at_us < end_us; at_us += 250'000) {
    player.rebase(range, at_us);
    EXPECT_EQ(*player.end_us(range), end_us) << "rebased at " << at_us;
  }
}

TEST(Player, StaysAtTheEndOnceItsEndHasBeenTaken) {
  for (const double speed : {1.0, -0.3}) {
    Player player = playing(Loop::Once, speed, kTwoSeconds);
    player.rebase(kTwoSeconds, *player.end_us(kTwoSeconds) + 12'345);
    EXPECT_FALSE(player.playing);
    EXPECT_FALSE(player.end_us(kTwoSeconds));
    const PlayerReading reading = player.read(kTwoSeconds, 500 * kSecond);
    EXPECT_FALSE(reading.ended);  // that was told
    EXPECT_EQ(reading.time_s, speed > 0.0 ? 2.0 : 0.0);
    EXPECT_DOUBLE_EQ(reading.played_s, seconds_between(0, *playing(Loop::Once, speed, kTwoSeconds).end_us(kTwoSeconds)));
  }
}

TEST(Player, NeverEndsUnlessItPlaysOnceAndMoves) {
  EXPECT_FALSE(Player{}.end_us(kTwoSeconds));
  EXPECT_FALSE(playing(Loop::Repeat, 1.0, kTwoSeconds).end_us(kTwoSeconds));
  EXPECT_FALSE(playing(Loop::PingPong, 1.0, kTwoSeconds).end_us(kTwoSeconds));
  EXPECT_FALSE(playing(Loop::Once, 0.0, kTwoSeconds).end_us(kTwoSeconds));
  EXPECT_FALSE(playing(Loop::Once, 1e-300, kTwoSeconds).end_us(kTwoSeconds)) << "beyond what a clock can count";
}

TEST(Player, EndsAsItStartsWhereThereIsNothingToPlay) {
  const PlayRange nothing{0.0, 0.0};
  for (const double speed : {1.0, 0.0, -1.0}) {
    const Player player = playing(Loop::Once, speed, nothing, 77);
    ASSERT_TRUE(player.end_us(nothing));
    EXPECT_EQ(*player.end_us(nothing), 77);
    EXPECT_TRUE(player.read(nothing, 77).ended);
    EXPECT_EQ(player.read(nothing, 77).time_s, 0.0);
  }
  for (const Loop loop : {Loop::Repeat, Loop::PingPong}) {
    const PlayerReading reading = playing(loop, 1.0, nothing).read(nothing, 5 * kSecond);
    EXPECT_EQ(reading.time_s, 0.0);
    EXPECT_EQ(reading.wraps, 0);
    EXPECT_FALSE(reading.ended);
  }
}

TEST(Player, ShowsAFiniteTimeOfTheRangeAtAnyFiniteSpeed) {
  for (const Loop loop : kLoops) {
    for (const double speed : {std::numeric_limits<double>::max(), -std::numeric_limits<double>::max(), 1e30, -1e30,
                               std::numeric_limits<double>::denorm_min()}) {
      const Player player = playing(loop, speed, kTwoSeconds);
      for (const ClockUs at_us : {ClockUs{0}, ClockUs{1}, kSecond, ClockUs{1'000'000} * kSecond}) {
        const double time_s = player.read(kTwoSeconds, at_us).time_s;
        EXPECT_TRUE(time_s >= 0.0 && time_s <= 2.0) << time_s << " at speed " << speed;
      }
    }
  }
}

TEST(PlayerSeek, TakesAnyTimeOfTheRangeWithBothItsEnds) {
  const PlayRange range{0.5, 1.5};
  for (const Loop loop : kLoops) {
    for (const double to_s : {0.5, 0.75, 1.0, 1.5}) {
      Player player;
      player.loop = loop;
      player.seek(range, to_s, 0);
      EXPECT_EQ(player.read(range, 0).time_s, to_s);
      EXPECT_EQ(player.read(range, kSecond).time_s, to_s);
      player.play(range, kSecond);
      if (loop != Loop::Once) {
        EXPECT_EQ(player.read(range, kSecond).time_s, to_s) << "playing has not passed it yet";
      }
    }
  }
}

TEST(PlayerSeek, ClampsForOnceAndWrapsForTheOthers) {
  const PlayRange range{0.5, 1.5};
  const auto sought = [&](Loop loop, double to_s) {
    Player player;
    player.loop = loop;
    player.seek(range, to_s, 0);
    return player.read(range, 0).time_s;
  };
  EXPECT_EQ(sought(Loop::Once, -3.0), 0.5);
  EXPECT_EQ(sought(Loop::Once, 1e300), 1.5);
  for (const Loop loop : {Loop::Repeat, Loop::PingPong}) {
    EXPECT_EQ(sought(loop, 1.75), 0.75);
    EXPECT_EQ(sought(loop, 3.25), 1.25);
    EXPECT_EQ(sought(loop, 0.25), 1.25);
    EXPECT_EQ(sought(loop, -100.0), 1.0);
    EXPECT_EQ(sought(loop, 2.5), 0.5) << "a whole range past the end is the start";
  }
}

TEST(PlayerSeek, GoesOnPlayingFromThere) {
  Player player = playing(Loop::Repeat, 1.0, kTwoSeconds);
  player.seek(kTwoSeconds, 1.25, 300'000);
  EXPECT_DOUBLE_EQ(player.read(kTwoSeconds, 800'000).time_s, 1.75);
  EXPECT_DOUBLE_EQ(player.read(kTwoSeconds, 1'300'000).time_s, 0.25);
}

TEST(PlayerSeek, LeavesAPingPongOnItsWayBack) {
  Player player = playing(Loop::PingPong, 1.0, kTwoSeconds);
  player.seek(kTwoSeconds, 1.5, 3 * kSecond);
  EXPECT_TRUE(player.read(kTwoSeconds, 3 * kSecond).backwards);
  EXPECT_DOUBLE_EQ(player.read(kTwoSeconds, 4 * kSecond).time_s, 0.5);
}

TEST(PlayerSeek, ToTheEndOfARepeatGoesRoundAsSoonAsItPlays) {
  Player player = playing(Loop::Repeat, 1.0, kTwoSeconds);
  player.seek(kTwoSeconds, 2.0, 0);
  EXPECT_EQ(player.read(kTwoSeconds, 0).time_s, 2.0);
  EXPECT_DOUBLE_EQ(player.read(kTwoSeconds, 250'000).time_s, 0.25);
}

TEST(PlayerSeek, ToTheEndOfARepeatIsHeldWhileTheSpeedIsZero) {
  Player player = playing(Loop::Repeat, 0.0, kTwoSeconds);
  player.seek(kTwoSeconds, 2.0, 0);
  EXPECT_EQ(player.read(kTwoSeconds, 0).time_s, 2.0);
  EXPECT_EQ(player.read(kTwoSeconds, kSecond).time_s, 2.0) << "no time has passed that could have gone past the end";
}

TEST(PlayerSeek, ToTheEndOfARepeatPlayedBackwardsPassesNoSeam) {
  Player player = playing(Loop::Repeat, -1.0, kTwoSeconds);
  player.seek(kTwoSeconds, 2.0, 0);
  const std::int64_t wraps = player.read(kTwoSeconds, 0).wraps;
  EXPECT_DOUBLE_EQ(player.read(kTwoSeconds, kSecond).time_s, 1.0);
  EXPECT_EQ(player.read(kTwoSeconds, kSecond).wraps, wraps);
}

TEST(PlayerSeek, NeverShowsATimeOutsideTheRangeWhateverTheRounding) {
  for (int in = 0; in < 100; ++in) {
    for (int out = in + 1; out < 200; ++out) {
      const PlayRange range{in / 100.0, out / 100.0};
      for (const Loop loop : kLoops) {
        Player player;
        player.loop = loop;
        player.seek(range, range.out_s, 0);
        ASSERT_LE(player.read(range, 0).time_s, range.out_s) << range.in_s;
        ASSERT_GE(player.read(range, 0).time_s, range.in_s);
      }
    }
  }
}

TEST(PlayerPlay, StartsAgainAfterTheEndOfAOnceInBothDirections) {
  for (const double speed : {1.0, -1.0}) {
    Player player = playing(Loop::Once, speed, kTwoSeconds);
    const std::uint64_t jumps = player.jumps;
    player.play(kTwoSeconds, 5 * kSecond);
    EXPECT_TRUE(player.playing);
    EXPECT_GT(player.jumps, jumps);
    EXPECT_EQ(player.read(kTwoSeconds, 5 * kSecond).time_s, speed > 0.0 ? 0.0 : 2.0);
    EXPECT_DOUBLE_EQ(player.read(kTwoSeconds, 5 * kSecond + 500'000).time_s, speed > 0.0 ? 0.5 : 1.5);
    EXPECT_EQ(*player.end_us(kTwoSeconds), 7 * kSecond);
  }
}

TEST(PlayerPlay, GoesBackFromTheEndOfAOnceWhenTheSpeedWasTurned) {
  Player player = playing(Loop::Once, 1.0, kTwoSeconds);
  player.set_speed(kTwoSeconds, -1.0, 3 * kSecond);
  player.play(kTwoSeconds, 3 * kSecond);
  EXPECT_EQ(player.read(kTwoSeconds, 3 * kSecond).time_s, 2.0);
  EXPECT_DOUBLE_EQ(player.read(kTwoSeconds, 4 * kSecond).time_s, 1.0);
}

TEST(PlayerPlay, DoesNotStartAgainBeforeTheEnd) {
  Player player = playing(Loop::Once, 1.0, kTwoSeconds);
  player.pause(kTwoSeconds, 1'999'999);
  const std::uint64_t jumps = player.jumps;
  player.play(kTwoSeconds, 3 * kSecond);
  EXPECT_EQ(player.jumps, jumps);
  EXPECT_NEAR(static_cast<double>(*player.end_us(kTwoSeconds)), 3e6 + 1.0, 1.0);
}

TEST(PlayerStop, PausesAtTheRangesStartWithoutSpin) {
  const PlayRange range{0.5, 1.5};
  for (const Loop loop : kLoops) {
    for (const double speed : {1.0, -1.0}) {
      Player player = playing(loop, speed, range);
      player.stop(range, 700'000);
      const PlayerReading reading = player.read(range, 9 * kSecond);
      EXPECT_FALSE(reading.playing);
      EXPECT_EQ(reading.time_s, 0.5);
      EXPECT_EQ(reading.played_s, 0.0);
    }
  }
}

TEST(PlayerChangeClip, StartsAtTheNewClipsStartOrBackwardsAtItsEnd) {
  for (const Loop loop : kLoops) {
    Player player = playing(loop, 1.0, kTwoSeconds);
    player.range = PlayRange{0.5, 1.0};
    player.change_clip(clip_of_length(5.0, "other"), kSecond);
    EXPECT_EQ(player.clip, "other");
    EXPECT_FALSE(player.range) << "the range is the whole clip again";
    EXPECT_EQ(player.read({0.0, 5.0}, kSecond).time_s, 0.0);
    EXPECT_DOUBLE_EQ(player.read({0.0, 5.0}, 2 * kSecond).time_s, 1.0);

    player = playing(loop, -1.0, kTwoSeconds);
    player.change_clip(clip_of_length(5.0, "other"), kSecond);
    EXPECT_EQ(player.read({0.0, 5.0}, kSecond).time_s, 5.0);
    EXPECT_DOUBLE_EQ(player.read({0.0, 5.0}, 2 * kSecond).time_s, 4.0);
  }
}

}  // namespace
}  // namespace tweend::stage
