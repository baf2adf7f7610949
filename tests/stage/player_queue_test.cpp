#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "server/stage/course.hpp"
#include "server/stage/show.hpp"
#include "tests/stage/players.hpp"

namespace tweend::stage {
namespace {

model::ClipPtr clip(const char* name, double length_s, std::initializer_list<double> markers = {}) {
  auto c = std::make_shared<model::Clip>(clip_of_length(length_s, name));
  auto list = std::make_shared<std::vector<model::Marker>>();
  for (const double t : markers) list->push_back({static_cast<model::KeyframeId>(list->size() + 1), t, "m"});
  if (!list->empty()) c->markers = list;
  return c;
}

model::Actor actor_of(std::vector<model::ClipPtr> clips) {
  model::Actor actor;
  actor.name = "actor";
  actor.clips = std::move(clips);
  return actor;
}

Player player_on(const model::Actor& actor, double speed = 1.0) {
  Player player;
  player.actor = actor.name;
  player.clip = actor.clips.front()->name;
  player.speed = speed;
  return player;
}

struct State {
  std::string clip;
  double time_s;
  bool playing;
};

State state_at(const model::Actor& actor, const Player& player, ClockUs at_us) {
  const Player there = reached(actor, player, at_us);
  const PlayerReading reading = there.read(there.range_of(*clip_of(actor, there)), at_us);
  return {there.clip, reading.time_s, reading.playing};
}

void expect_state(const State& found, const State& wanted, const char* when) {
  EXPECT_EQ(found.clip, wanted.clip) << when;
  EXPECT_NEAR(found.time_s, wanted.time_s, 1e-9) << when;
  EXPECT_EQ(found.playing, wanted.playing) << when;
}

TEST(PlayerQueue, PlaysOneAfterAnotherAndHoldsTheEnd) {
  const model::Actor actor = actor_of({clip("a", 2.0), clip("b", 1.0)});
  Player player = player_on(actor);
  player.start_queue(actor, {{.clip = "a"}, {.clip = "b", .repeat = 2}}, 0);
  expect_state(state_at(actor, player, 0), {"a", 0.0, true}, "at first");
  expect_state(state_at(actor, player, 1'999'999), {"a", 1.999999, true}, "before the seam");
  expect_state(state_at(actor, player, 2'000'000), {"b", 0.0, true}, "at the seam");
  expect_state(state_at(actor, player, 3'250'000), {"b", 0.25, true}, "the second time");
  expect_state(state_at(actor, player, 3'999'999), {"b", 0.999999, true}, "before the end");
  expect_state(state_at(actor, player, 4'000'000), {"b", 1.0, false}, "at the end");
  expect_state(state_at(actor, player, 9'000'000), {"b", 1.0, false}, "long after");
  const Player after = reached(actor, player, 9'000'000);
  EXPECT_FALSE(after.queue);
  EXPECT_EQ(after.loop, Loop::Repeat) << "the player's own";
}

TEST(PlayerQueue, GoesThereAndBackInAPingPong) {
  const model::Actor actor = actor_of({clip("a", 1.0), clip("b", 1.0)});
  Player player = player_on(actor);
  player.start_queue(actor, {{.clip = "a", .loop = Loop::PingPong}, {.clip = "b"}}, 0);
  expect_state(state_at(actor, player, 1'250'000), {"a", 0.75, true}, "on its way back");
  expect_state(state_at(actor, player, 2'250'000), {"b", 0.25, true}, "after it");
}

TEST(PlayerQueue, BackwardsPlaysEachFromItsEnd) {
  const model::Actor actor = actor_of({clip("a", 2.0), clip("b", 1.0)});
  Player player = player_on(actor, -2.0);
  player.start_queue(actor, {{.clip = "a"}, {.clip = "b", .repeat = 2}}, 0);
  expect_state(state_at(actor, player, 0), {"a", 2.0, true}, "at first");
  expect_state(state_at(actor, player, 250'000), {"a", 1.5, true}, "a");
  expect_state(state_at(actor, player, 1'250'000), {"b", 0.5, true}, "b");
  expect_state(state_at(actor, player, 1'750'000), {"b", 0.5, true}, "b again");
  expect_state(state_at(actor, player, 2'000'000), {"b", 0.0, false}, "the end");
}

TEST(PlayerQueue, PassesOverWhatHasNoLengthOrIsGone) {
  const model::Actor actor = actor_of({clip("a", 1.0), clip("still", 0.0), clip("b", 1.0)});
  Player player = player_on(actor);
  player.start_queue(actor, {{.clip = "still", .repeat = 5}, {.clip = "a"}, {.clip = "gone"}, {.clip = "still"}, {.clip = "b"}},
                     0);
  expect_state(state_at(actor, player, 500'000), {"a", 0.5, true}, "a");
  expect_state(state_at(actor, player, 1'500'000), {"b", 0.5, true}, "b");
}

TEST(PlayerQueue, EndsWithSeekStopLoopRangeAndAnotherClipButNotWithPauseAndSpeed) {
  const model::Actor actor = actor_of({clip("a", 2.0), clip("b", 1.0)});
  const PlayRange r{0.0, 2.0};
  Player begun = player_on(actor);
  begun.start_queue(actor, {{.clip = "a", .repeat = 3}, {.clip = "b"}}, 0);
  const auto with = [&](auto act) {
    Player player = begun;
    act(player);
    return player;
  };
  EXPECT_FALSE(with([&](Player& p) { p.seek(r, 1.0, kSecond); }).queue);
  EXPECT_FALSE(with([&](Player& p) { p.stop(r, kSecond); }).queue);
  EXPECT_FALSE(with([&](Player& p) { p.set_loop(r, Loop::Once, kSecond); }).queue);
  EXPECT_FALSE(with([&](Player& p) { p.set_range(*actor.clips[0], PlayRange{0.0, 1.5}, kSecond); }).queue);
  EXPECT_FALSE(with([&](Player& p) { p.change_clip(*actor.clips[1], kSecond); }).queue);
  const Player left = with([&](Player& p) { p.leave_queue(r, 2'500'000); });
  expect_state(state_at(actor, left, 2'500'000), {"a", 0.5, true}, "where it was");
  expect_state(state_at(actor, left, 99'500'000), {"a", 1.5, true}, "alone, by the player's own loop");

  Player paused = with([&](Player& p) { p.pause(r, 2'500'000); });
  expect_state(state_at(actor, paused, 50 * kSecond), {"a", 0.5, false}, "paused in the second lap");
  paused.play(r, 50 * kSecond);
  expect_state(state_at(actor, paused, 50 * kSecond + 3'500'000), {"b", 0.0, true}, "3.5 s were left");
  const Player faster = with([&](Player& p) { p.set_speed(r, 2.0, 2 * kSecond); });
  expect_state(state_at(actor, faster, 4 * kSecond), {"b", 0.0, true}, "2 s, then 4 s at twice the speed");
}

TEST(PlayerQueue, TurnsAroundWithItsSpeed) {
  const model::Actor actor = actor_of({clip("a", 2.0), clip("b", 1.0)});
  Player player = player_on(actor);
  player.start_queue(actor, {{.clip = "a"}, {.clip = "b"}}, 0);
  player.set_speed({0.0, 2.0}, -1.0, 500'000);
  expect_state(state_at(actor, player, 750'000), {"a", 0.25, true}, "back");
  expect_state(state_at(actor, player, 1'250'000), {"b", 0.75, true}, "the next one from its end");
}

/// Seams don't drift: after thousands of clips that take no whole number of microseconds, time is where arithmetic has it.
TEST(PlayerQueue, HasSeamsThatDontDrift) {
  const model::Actor actor = actor_of({clip("a", 1.0 / 3.0), clip("b", 0.1)});
  std::vector<QueueEntry> entries;
  for (int i = 0; i < 1'000; ++i) {
    entries.push_back({.clip = "a"});
    entries.push_back({.clip = "b", .repeat = 3});
  }
  entries.push_back({.clip = "a", .repeat = 1'000});
  for (const double speed : {1.7, 130.0, -0.9}) {
    Player player = player_on(actor, speed);
    player.start_queue(actor, entries, 17);
    const double way_s = 1'000.0 * (1.0 / 3.0 + 0.3) + 1.0 / 9.0;
    const ClockUs at = 17 + static_cast<ClockUs>(std::ceil(way_s / std::abs(speed) * 1e6));
    const double over_s = std::abs(speed) * seconds_between(17, at) - way_s + 1.0 / 9.0;
    expect_state(state_at(actor, player, at), {"a", speed > 0.0 ? over_s : 1.0 / 3.0 - over_s, true}, "the last one");
  }
}

TEST(PlayerQueue, ReadsTheSameHoweverOftenItWasMovedOn) {
  std::mt19937 random(9);
  const auto uniform = [&random](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int run = 0; run < 200; ++run) {
    const model::Actor actor = actor_of({clip("a", uniform(0.05, 1.0)), clip("b", uniform(0.05, 1.0))});
    Player player = player_on(actor, uniform(-5.0, 5.0));
    std::vector<QueueEntry> entries;
    for (int i = 0; i < 6; ++i) {
      entries.push_back({i % 2 == 0 ? "a" : "b", kLoops[random() % 3], 1 + static_cast<std::int64_t>(random() % 3),
                         random() % 2 == 0 ? 0.0 : uniform(0.01, 0.5)});
    }
    player.start_queue(actor, entries, 0);
    Player often = player;
    for (ClockUs at = 0; at < 3 * kSecond; at += 37'003) {
      often = reached(actor, often, at);
      EXPECT_EQ(often, reached(actor, player, at));
    }
  }
}

TEST(RunPlayer, PassesTheMarkersOfAllClipsOnItsWay) {
  const model::Actor actor = actor_of({clip("a", 2.0, {0.0, 0.5, 2.0}), clip("b", 1.0, {0.0, 0.25})});
  Player player = player_on(actor, 8.0);
  player.start_queue(actor, {{.clip = "a"}, {.clip = "b", .repeat = 2}}, 0);
  const Course course = run_player(actor, player, 0, kSecond, 100);
  EXPECT_TRUE(course.moved);
  EXPECT_TRUE(course.ended);
  std::string order;
  for (const Passed& p : course.passed) order += p.clip->name + std::to_string(p.marker) + "@" + std::to_string(p.at_us) + " ";
  EXPECT_EQ(order, "a1@62500 a2@250000 b0@250000 b1@281250 b0@375000 b1@406250 ") << "a0 is where it began";
  ASSERT_EQ(markers_at_start(actor, player).size(), 1U);
}

TEST(RunPlayer, InPartsIsTheWhole) {
  std::mt19937 random(21);
  const auto uniform = [&random](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int run = 0; run < 300; ++run) {
    const double a_s = uniform(0.01, 1.0);
    const model::Actor actor =
        actor_of({clip("a", a_s, {0.0, uniform(0.0, a_s), a_s}), clip("b", uniform(0.3, 1.0), {0.0, 0.1, 0.2})});
    Player player = player_on(actor, uniform(-9.0, 9.0));
    std::vector<QueueEntry> entries;
    for (int i = 0; i < 5; ++i)
      entries.push_back({i % 2 == 0 ? "a" : "b", kLoops[random() % 3], 1 + static_cast<int>(random() % 3), 0.0});
    player.start_queue(actor, entries, 0);
    const Course whole = run_player(actor, player, 0, 4 * kSecond, 10'000);
    Player part = player;
    std::vector<Passed> passed;
    for (ClockUs at = 0; at < 4 * kSecond;) {
      const ClockUs next = std::min<ClockUs>(at + 1 + static_cast<ClockUs>(uniform(0.0, 3e5)), 4 * kSecond);
      Course course = run_player(actor, part, at, next, 10'000);
      passed.insert(passed.end(), course.passed.begin(), course.passed.end());
      part = std::move(course.player);
      at = next;
    }
    EXPECT_EQ(part.clip, whole.player.clip);
    ASSERT_EQ(passed.size(), whole.passed.size());
    for (std::size_t i = 0; i < passed.size(); ++i) {
      EXPECT_EQ(passed[i].at_us, whole.passed[i].at_us);
      EXPECT_EQ(passed[i].marker, whole.passed[i].marker);
    }
  }
}

}  // namespace
}  // namespace tweend::stage
