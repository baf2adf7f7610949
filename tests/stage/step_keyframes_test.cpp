#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "server/stage/player.hpp"

namespace tweend::stage {
namespace {

constexpr Loop kLoops[] = {Loop::Once, Loop::Repeat, Loop::PingPong};
const std::vector<double> kTimes{0.0, 1.0, 2.5, 4.0};
constexpr PlayRange kWhole{0.0, 4.0};

TEST(StepKeyframes, GoesToTheNthNextOrPreviousKey) {
  for (const Loop loop : kLoops) {
    EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 0.0, 1), 1.0);
    EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 0.0, 3), 4.0);
    EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 0.5, 1), 1.0);
    EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 0.5, 2), 2.5);
    EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 4.0, -1), 2.5);
    EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 3.0, -1), 2.5);
    EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 3.0, -3), 0.0);
  }
}

TEST(StepKeyframes, StaysWhereItIsForNoSteps) {
  for (const Loop loop : kLoops) EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 0.7, 0), 0.7);
}

TEST(StepKeyframes, StaysAtTheLastKeyForOnce) {
  EXPECT_EQ(step_keyframes(kTimes, kWhole, Loop::Once, 4.0, 1), 4.0);
  EXPECT_EQ(step_keyframes(kTimes, kWhole, Loop::Once, 0.5, 100), 4.0);
  EXPECT_EQ(step_keyframes(kTimes, kWhole, Loop::Once, 0.0, -1), 0.0);
  EXPECT_EQ(step_keyframes(kTimes, kWhole, Loop::Once, 3.0, -100), 0.0);
}

TEST(StepKeyframes, GoesOnAroundForTheOthers) {
  for (const Loop loop : {Loop::Repeat, Loop::PingPong}) {
    EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 4.0, 1), 0.0);
    EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 0.0, -1), 4.0);
    EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 1.0, 4), 1.0);
    EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 1.0, -4), 1.0);
    EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 1.0, 401), 2.5);
    EXPECT_EQ(step_keyframes(kTimes, kWhole, loop, 1.0, -401), 0.0);
  }
}

TEST(StepKeyframes, SeesOnlyTheKeysOfTheRangeWithBothItsEnds) {
  const PlayRange range{1.0, 2.5};
  for (const Loop loop : {Loop::Repeat, Loop::PingPong}) {
    EXPECT_EQ(step_keyframes(kTimes, range, loop, 1.0, 1), 2.5);
    EXPECT_EQ(step_keyframes(kTimes, range, loop, 2.5, 1), 1.0);
    EXPECT_EQ(step_keyframes(kTimes, range, loop, 1.0, -1), 2.5);
  }
  EXPECT_EQ(step_keyframes(kTimes, range, Loop::Once, 2.5, 1), 2.5);
  EXPECT_EQ(step_keyframes(kTimes, range, Loop::Once, 1.0, -1), 1.0);
}

TEST(StepKeyframes, SaysSoWhereThereIsNoKey) {
  for (const Loop loop : kLoops) {
    EXPECT_EQ(step_keyframes({}, {0.0, 0.0}, loop, 0.0, 1), std::nullopt);
    EXPECT_EQ(step_keyframes(kTimes, {2.6, 3.9}, loop, 3.0, 1), std::nullopt);
    EXPECT_EQ(step_keyframes(kTimes, {2.6, 3.9}, loop, 3.0, 0), std::nullopt);
  }
}

// What playback.step does: read where the playhead is, seek the key after it.
std::vector<double> keys_visited(Player player, const std::vector<double>& times_s, const PlayRange& range, std::int64_t n,
                                 ClockUs at_us) {
  std::vector<double> visited;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const double here_s = player.read(range, at_us).time_s;
    const auto there_s = step_keyframes(times_s, range, player.loop, here_s, n);
    if (!there_s) break;
    visited.push_back(*there_s);
    player.seek(range, *there_s, at_us);
  }
  return visited;
}

std::vector<double> hundredths(int from, int to) {
  std::vector<double> times_s;
  for (int i = from; i <= to; ++i) times_s.push_back(i / 100.0);
  return times_s;
}

TEST(StepKeyframes, StepByStepVisitsEveryKeyOnce) {
  const std::vector<double> times_s = hundredths(1, 300);
  for (const Loop loop : kLoops) {
    Player player;
    player.loop = loop;
    EXPECT_EQ(keys_visited(player, times_s, {0.0, 3.0}, 1, 0), times_s);
    player.seek({0.0, 3.0}, 3.0, 0);
    const std::vector<double> back = keys_visited(player, times_s, {0.0, 3.0}, -1, 0);
    ASSERT_EQ(back.size(), times_s.size());
    for (std::size_t i = 0; i + 1 < back.size(); ++i) EXPECT_EQ(back[i], times_s[times_s.size() - 2 - i]);
  }
}

TEST(StepKeyframes, StepByStepVisitsEveryKeyOfARangeOnceInBothDirections) {
  for (int in = 1; in < 100; in += 7) {
    const PlayRange range{in / 100.0, 3.0};
    const std::vector<double> times_s = hundredths(in, 300);
    Player player;
    player.loop = Loop::Once;
    player.seek(range, range.in_s, 0);
    const std::vector<double> forth = keys_visited(player, times_s, range, 1, 0);
    for (std::size_t i = 0; i + 1 < times_s.size(); ++i) ASSERT_EQ(forth[i], times_s[i + 1]) << "from " << range.in_s;
    player.seek(range, range.out_s, 0);
    const std::vector<double> back = keys_visited(player, times_s, range, -1, 0);
    for (std::size_t i = 0; i + 1 < times_s.size(); ++i) {
      ASSERT_EQ(back[i], times_s[times_s.size() - 2 - i]) << "from " << range.in_s;
    }
  }
}

TEST(StepKeyframes, StepByStepVisitsEveryKeyOnAPingPongsWayBack) {
  const std::vector<double> times_s = hundredths(0, 300);
  const PlayRange range{0.0, 3.0};
  Player player;
  player.loop = Loop::PingPong;
  player.play(range, 0);
  player.pause(range, 4'000'000);  // at 2 s, on the way back
  player.seek(range, 0.0, 4'000'000);
  const std::vector<double> forth = keys_visited(player, times_s, range, 1, 4'000'000);
  ASSERT_EQ(forth.size(), times_s.size());
  for (std::size_t i = 0; i + 1 < times_s.size(); ++i) ASSERT_EQ(forth[i], times_s[i + 1]);
}

}  // namespace
}  // namespace tweend::stage
