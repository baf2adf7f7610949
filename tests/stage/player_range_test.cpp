#include <gtest/gtest.h>

#include "server/stage/player.hpp"
#include "tests/stage/players.hpp"
#include "tests/support/scenes.hpp"

namespace tweend::stage {
namespace {

TEST(PlayerRange, IsTheWholeClipHoweverItGrowsUntilItIsSet) {
  Player player;
  EXPECT_EQ(player.range_of(clip_of_length(2.0)), (PlayRange{0.0, 2.0}));
  EXPECT_EQ(player.range_of(clip_of_length(9.0)), (PlayRange{0.0, 9.0}));
  player.set_range(clip_of_length(2.0), PlayRange{0.5, 1.5}, 0);
  EXPECT_EQ(player.range_of(clip_of_length(9.0)), (PlayRange{0.5, 1.5}));
  player.set_range(clip_of_length(9.0), std::nullopt, 0);
  EXPECT_EQ(player.range_of(clip_of_length(9.0)), (PlayRange{0.0, 9.0}));
}

TEST(PlayerRange, IsCutToAClipThatHasShrunk) {
  Player player;
  player.set_range(clip_of_length(9.0), PlayRange{2.0, 8.0}, 0);
  EXPECT_EQ(player.range_of(clip_of_length(5.0)), (PlayRange{2.0, 5.0}));
  EXPECT_EQ(player.range_of(clip_of_length(2.0)), (PlayRange{0.0, 2.0})) << "nothing of it is left";
  EXPECT_EQ(player.range_of(clip_of_length(1.0)), (PlayRange{0.0, 1.0}));
  EXPECT_EQ(player.range_of(clip_of_length(9.0)), (PlayRange{2.0, 8.0})) << "and it is whole again when the clip grows";
}

TEST(PlayerRange, KeepsATimeThatItHolds) {
  const model::Clip clip = clip_of_length(4.0);
  for (const Loop loop : kLoops) {
    Player player = playing(loop, 1.0, {0.0, 4.0});
    const std::uint64_t jumps = player.jumps;
    player.set_range(clip, PlayRange{1.0, 3.0}, 1'250'000);
    EXPECT_EQ(player.read(player.range_of(clip), 1'250'000).time_s, 1.25);
    EXPECT_DOUBLE_EQ(player.read(player.range_of(clip), 2 * kSecond).time_s, 2.0);
    EXPECT_EQ(player.jumps, jumps);
    EXPECT_TRUE(player.playing);
  }
}

TEST(PlayerRange, BringsATimeOutsideIntoItWithAJump) {
  const model::Clip clip = clip_of_length(4.0);
  for (const Loop loop : kLoops) {
    Player player = playing(loop, 1.0, {0.0, 4.0});
    const std::uint64_t jumps = player.jumps;
    player.set_range(clip, PlayRange{1.0, 2.5}, 3'000'000);
    EXPECT_DOUBLE_EQ(player.read(player.range_of(clip), 3'000'000).time_s, loop == Loop::Once ? 2.5 : 1.5);
    EXPECT_EQ(player.jumps, jumps + 1);
  }
}

TEST(PlayerRange, WrapsWithinItself) {
  const model::Clip clip = clip_of_length(4.0);
  Player player;
  player.set_range(clip, PlayRange{1.0, 2.0}, 0);
  player.seek({1.0, 2.0}, 1.5, 0);
  player.play({1.0, 2.0}, 0);
  EXPECT_DOUBLE_EQ(player.read({1.0, 2.0}, 750'000).time_s, 1.25);
  EXPECT_EQ(player.read({1.0, 2.0}, 750'000).wraps, 1);
}

TEST(PlayerFollow, KeepsTheTimeOfAClipThatGrowsAndGoesOnBeyond) {
  for (const Loop loop : kLoops) {
    Player player = playing(loop, 1.0, kTwoSeconds);
    player.follow(kTwoSeconds, {0.0, 10.0}, 1'500'000);
    EXPECT_DOUBLE_EQ(player.read({0.0, 10.0}, 1'500'000).time_s, 1.5);
    EXPECT_DOUBLE_EQ(player.read({0.0, 10.0}, 4 * kSecond).time_s, 4.0);
  }
}

TEST(PlayerFollow, BringsATimeBeyondAShrunkClipIntoIt) {
  for (const Loop loop : kLoops) {
    Player player = playing(loop, 1.0, {0.0, 4.0});
    player.follow({0.0, 4.0}, {0.0, 2.0}, 3 * kSecond);
    EXPECT_DOUBLE_EQ(player.read({0.0, 2.0}, 3 * kSecond).time_s, loop == Loop::Once ? 2.0 : 1.0);
  }
}

TEST(PlayerFollow, LeavesAPingPongOnItsWayBack) {
  Player player = playing(Loop::PingPong, 1.0, kTwoSeconds);
  player.follow(kTwoSeconds, {0.0, 5.0}, 3 * kSecond);
  EXPECT_DOUBLE_EQ(player.read({0.0, 5.0}, 3 * kSecond).time_s, 1.0);
  EXPECT_DOUBLE_EQ(player.read({0.0, 5.0}, 3'500'000).time_s, 0.5);
}

TEST(PlayerSpin, TurnsOnlyWhilePlaying) {
  for (const Loop loop : {Loop::Repeat, Loop::PingPong}) {
    Player player = playing(loop, 3.0, kTwoSeconds);
    EXPECT_DOUBLE_EQ(player.read(kTwoSeconds, kSecond).played_s, 1.0) << "clock seconds, not media seconds";
    player.pause(kTwoSeconds, kSecond);
    EXPECT_DOUBLE_EQ(player.read(kTwoSeconds, 50 * kSecond).played_s, 1.0);
    player.seek(kTwoSeconds, 0.5, 50 * kSecond);
    player.set_speed(kTwoSeconds, -2.0, 50 * kSecond);
    player.play(kTwoSeconds, 60 * kSecond);
    EXPECT_DOUBLE_EQ(player.read(kTwoSeconds, 62 * kSecond).played_s, 3.0);
  }
}

TEST(PlayerJumps, CountSeeksStopsAndClipChangesAndNothingElse) {
  Player player;
  const auto expect_jump = [&](bool jumped, auto&& act) {
    const std::uint64_t before = player.jumps;
    act();
    EXPECT_EQ(player.jumps, before + (jumped ? 1 : 0));
  };
  expect_jump(false, [&] { player.play(kTwoSeconds, 0); });
  expect_jump(false, [&] { player.set_speed(kTwoSeconds, -2.0, 100); });
  expect_jump(false, [&] { player.set_loop(kTwoSeconds, Loop::PingPong, 200); });
  expect_jump(false, [&] { player.rebase(kTwoSeconds, 300); });
  expect_jump(false, [&] { player.pause(kTwoSeconds, 400); });
  expect_jump(true, [&] { player.seek(kTwoSeconds, 1.0, 500); });
  expect_jump(true, [&] { player.stop(kTwoSeconds, 600); });
  expect_jump(true, [&] { player.change_clip(clip_of_length(1.0), 700); });
}

TEST(PlayerWraps, CountEachPassOfARepeatsSeam) {
  const Player forth = playing(Loop::Repeat, 1.0, kTwoSeconds);
  EXPECT_EQ(forth.read(kTwoSeconds, 1'999'999).wraps, 0);
  EXPECT_EQ(forth.read(kTwoSeconds, 2'000'001).wraps, 1);
  EXPECT_EQ(forth.read(kTwoSeconds, 7 * kSecond).wraps, 3);
  const Player back = playing(Loop::Repeat, -1.0, kTwoSeconds);
  const std::int64_t first = back.read(kTwoSeconds, 1).wraps;
  EXPECT_EQ(back.read(kTwoSeconds, 1'999'999).wraps, first);
  EXPECT_NE(back.read(kTwoSeconds, 2'000'001).wraps, first);
  EXPECT_EQ(playing(Loop::PingPong, 1.0, kTwoSeconds).read(kTwoSeconds, 7 * kSecond).wraps, 0);
}

TEST(PlayerWraps, GoOnThroughARebaseAndAPause) {
  Player player = playing(Loop::Repeat, 1.0, kTwoSeconds);
  for (ClockUs at_us = 0; at_us <= 11 * kSecond; at_us += 700'000) {
    player.rebase(kTwoSeconds, at_us);
    EXPECT_EQ(player.read(kTwoSeconds, at_us).wraps, at_us / (2 * kSecond));
  }
  player.pause(kTwoSeconds, 11 * kSecond);
  EXPECT_EQ(player.read(kTwoSeconds, 90 * kSecond).wraps, 5);
  player.play(kTwoSeconds, 90 * kSecond);
  EXPECT_EQ(player.read(kTwoSeconds, 91 * kSecond + 500'000).wraps, 6);
}

}  // namespace
}  // namespace tweend::stage
