#include "server/stage/show.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "tests/support/scenes.hpp"

namespace tweend::stage {
namespace {

using test::rising_clip;
using test::scene_of;
using test::square_actor;

constexpr ClockUs kSecond = 1'000'000;

Player player_of(const model::ActorPtr& actor) {
  Player player;
  player.actor = actor->name;
  player.clip = actor->clips.front()->name;
  return player;
}

/// An actor of one clip of keyframes at 0, 1 and 2 s, and a player that plays it from the reading 0.
struct OnStage {
  explicit OnStage(bool closed, double speed = 1.0, Loop loop = Loop::Repeat) {
    actor = square_actor("square", {{.closed = closed}});
    player = player_of(actor);
    player.speed = speed;
    player.loop = loop;
    player.play(range(), 0);
  }
  [[nodiscard]] PlayRange range() const { return player.range_of(*actor->clips.front()); }
  [[nodiscard]] ActorShow at(ClockUs at_us) const { return show_actor(actor, player, at_us); }

  model::ActorPtr actor;
  Player player;
};

TEST(ShowActor, ShowsThePlayersClipAtItsTime) {
  const OnStage stage(false);
  const ActorShow show = stage.at(1'500'000);
  EXPECT_EQ(show.actor, stage.actor);
  EXPECT_EQ(show.clip, stage.actor->clips.front());
  EXPECT_DOUBLE_EQ(show.time_s, 1.5);
}

TEST(ShowActor, FallsBackToTheFirstClipWhereThePlayersIsGone) {
  const model::ActorPtr actor = square_actor("square", {{.name = "first"}, {.name = "second", .first_id = 10}});
  Player player = player_of(actor);
  player.clip = "gone";
  EXPECT_EQ(clip_of(*actor, player), actor->clips[0]);
  player.clip = "second";
  EXPECT_EQ(clip_of(*actor, player), actor->clips[1]);
}

TEST(ShowActor, TurnsBySpinTimesTheSecondsPlayed) {
  OnStage stage(false, 5.0);
  auto spinning = std::make_shared<model::Actor>(*stage.actor);
  spinning->settings.spin_rad_s = 0.5;
  stage.actor = spinning;
  EXPECT_DOUBLE_EQ(stage.at(3 * kSecond).spin_angle_rad, 1.5);
  stage.player.pause(stage.range(), 4 * kSecond);
  EXPECT_DOUBLE_EQ(stage.at(90 * kSecond).spin_angle_rad, 2.0);
  stage.player.stop(stage.range(), 90 * kSecond);
  EXPECT_EQ(stage.at(91 * kSecond).spin_angle_rad, 0.0);
}

TEST(ShowActor, MovesWhileItsTimeDoes) {
  EXPECT_TRUE(OnStage(false).at(kSecond).moving);
  EXPECT_FALSE(OnStage(false, 0.0).at(kSecond).moving);
  OnStage once(false, 1.0, Loop::Once);
  EXPECT_TRUE(once.at(1'999'999).moving);
  EXPECT_FALSE(once.at(2 * kSecond).moving);
  OnStage paused(false);
  paused.player.pause(paused.range(), kSecond);
  EXPECT_FALSE(paused.at(kSecond).moving);
  const model::ActorPtr still = square_actor("still", {{.keys = 1}});
  Player player = player_of(still);
  player.play({0.0, 0.0}, 0);
  EXPECT_FALSE(show_actor(still, player, kSecond).moving) << "there is no time to pass in a clip of one keyframe";
}

TEST(ShowContinuity, HoldsWhileTimeRunsOrRests) {
  OnStage stage(false);
  const std::uint64_t first = stage.at(0).continuity;
  EXPECT_EQ(stage.at(1'999'999).continuity, first);
  stage.player.pause(stage.range(), kSecond);
  EXPECT_EQ(stage.at(kSecond).continuity, first);
  EXPECT_EQ(stage.at(9 * kSecond).continuity, first);
  stage.player.play(stage.range(), 9 * kSecond);
  EXPECT_EQ(stage.at(9 * kSecond + 1).continuity, first);
  stage.player.set_speed(stage.range(), -3.0, 9 * kSecond);
  EXPECT_EQ(stage.at(9 * kSecond + 1).continuity, first);
  stage.player.set_loop(stage.range(), Loop::PingPong, 9 * kSecond);
  EXPECT_EQ(stage.at(12 * kSecond).continuity, first) << "a ping-pong turns without a jump";
}

TEST(ShowContinuity, ChangesAtASeekAStopAndAClipChange) {
  OnStage stage(false);
  std::uint64_t last = stage.at(500'000).continuity;
  const auto expect_jump = [&] {
    EXPECT_NE(stage.at(500'000).continuity, last);
    last = stage.at(500'000).continuity;
  };
  stage.player.seek(stage.range(), 1.0, 500'000);
  expect_jump();
  stage.player.change_clip(*stage.actor->clips.front(), 500'000);
  expect_jump();
  stage.player.stop(stage.range(), 500'000);
  expect_jump();
}

TEST(ShowContinuity, ChangesWhenAnOpenClipWraps) {
  const OnStage stage(false);
  EXPECT_NE(stage.at(2'000'001).continuity, stage.at(1'999'999).continuity);
  EXPECT_EQ(stage.at(3'999'999).continuity, stage.at(2'000'001).continuity);
  EXPECT_NE(stage.at(4'000'001).continuity, stage.at(3'999'999).continuity);
  OnStage back(false, -1.0);
  back.player.seek(back.range(), 1.0, 0);
  EXPECT_NE(back.at(1'000'001).continuity, back.at(999'999).continuity);
}

TEST(ShowContinuity, HoldsWhenAClosedClipPlayedWholeWraps) {
  const OnStage stage(true);
  ASSERT_DOUBLE_EQ(stage.range().length_s(), 3.0);
  EXPECT_EQ(stage.at(3'000'001).continuity, stage.at(2'999'999).continuity);
  EXPECT_EQ(stage.at(100 * kSecond).continuity, stage.at(0).continuity);
}

TEST(ShowContinuity, ChangesWhenAPartOfAClosedClipWraps) {
  OnStage stage(true);
  stage.player.set_range(*stage.actor->clips.front(), PlayRange{0.0, 2.0}, 0);
  EXPECT_NE(stage.at(2'000'001).continuity, stage.at(1'999'999).continuity);
}

TEST(ShowContinuity, HoldsWhenARangeIsSetAroundTheTimeOfAClosedClip) {
  OnStage stage(true);
  const ClockUs at_us = 7 * kSecond;  // in the third round
  const ActorShow before = stage.at(at_us);
  stage.player.set_range(*stage.actor->clips.front(), PlayRange{0.0, 2.0}, at_us);
  EXPECT_DOUBLE_EQ(stage.at(at_us).time_s, before.time_s);
  EXPECT_EQ(stage.at(at_us).continuity, before.continuity) << "nothing has jumped";
}

TEST(ShowContinuity, HoldsAfterASeekToTheEndPlayedBackwards) {
  OnStage stage(false, -1.0);
  stage.player.seek(stage.range(), 2.0, kSecond);
  EXPECT_EQ(stage.at(kSecond + 1).continuity, stage.at(kSecond).continuity);
}

TEST(ShowAt, ShowsEveryActorAtTheSameReading) {
  const model::ActorPtr left = square_actor("left");
  const model::ActorPtr right = square_actor("right");
  auto players = std::make_shared<Players>();
  for (const model::ActorPtr& actor : {left, right}) {
    Player player = player_of(actor);
    player.play({0.0, 2.0}, 0);
    players->push_back(std::move(player));
  }
  const SceneView view{scene_of("main", {left, right}), players, 1};
  const Show show = show_at(view, 1'250'000);
  EXPECT_EQ(show.scene, view.scene);
  EXPECT_EQ(show.at_us, 1'250'000);
  ASSERT_EQ(show.actors.size(), 2U);
  EXPECT_EQ(show.actors[0].actor, left);
  EXPECT_EQ(show.actors[1].actor, right);
  EXPECT_EQ(show.actors[0].time_s, show.actors[1].time_s);
}

TEST(SceneView, FindsPlayersByTheirActors) {
  auto players = std::make_shared<Players>(2);
  (*players)[0].actor = "left";
  (*players)[1].actor = "right";
  const SceneView view{scene_of("main"), players, 1};
  EXPECT_EQ(view.find_player("right"), &(*players)[1]);
  EXPECT_EQ(view.find_player("up"), nullptr);
}

TEST(StageView, FindsScenesByTheirNames) {
  StageView view;
  const auto scene = std::make_shared<const SceneView>(SceneView{scene_of("main"), std::make_shared<const Players>(), 1});
  view.scenes["main"] = scene;
  EXPECT_EQ(view.find("main"), scene);
  EXPECT_EQ(view.find("other"), nullptr);
}

}  // namespace
}  // namespace tweend::stage
