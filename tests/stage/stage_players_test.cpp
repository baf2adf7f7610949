#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/stage/stage.hpp"
#include "tests/support/running_stage.hpp"

namespace tweend::stage {
namespace {

using test::ClipParts;
using test::rising_clip;
using test::RunningStage;
using test::scene_of;
using test::square_actor;
using test::square_at;
using Kind = RunningStage::Kind;

void play_once(Player& player, const PlayRange& range, ClockUs now_us) {
  player.set_loop(range, Loop::Once, now_us);
  player.play(range, now_us);
}

/// What an edit that adds a keyframe at a time is made of.
Change keyframe_at(const RunningStage& stage, const std::string& actor, double time_s, model::KeyframeId id) {
  const model::ActorPtr at = stage.view()->scene->find_actor(actor);
  return SetKeyframe{actor, at->clips[0]->name, id, TimedKeyframe{time_s, {id, {}, {}, square_at(*at->model->mesh, 5.0F)}}};
}

TEST(StagePlayers, ChangeWithoutAnEdit) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  const PlayersAnswer answer = stage.act(&Player::play);
  EXPECT_EQ(answer.concerned, (std::vector<std::size_t>{0}));
  EXPECT_EQ(answer.view, stage.view());
  EXPECT_TRUE(answer.view->players->at(0).playing);
  EXPECT_EQ(stage.revision(), 0U);
  EXPECT_TRUE(stage.store.groups().empty());
}

TEST(StagePlayers, ArePublishedThenToldThenAnswered) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  std::promise<std::pair<bool, std::size_t>> at_answer;
  stage->change_players("main", RunningStage::every_player(&Player::play), [&](const Result<PlayersAnswer>& answer) {
    at_answer.set_value({stage.view() == answer->view, stage.count(Kind::PlayersChanged)});
  });
  const auto [published, told] = at_answer.get_future().get();
  EXPECT_TRUE(published);
  EXPECT_EQ(told, 1U);
  stage.wait_for(Kind::PlayersChanged, 1);
  EXPECT_EQ(stage.told().back().view, stage.view());
}

TEST(StagePlayers, AllStartAtTheSameReading) {
  RunningStage stage({scene_of("main", {square_actor("a"), square_actor("b"), square_actor("c")})});
  stage.start();
  const PlayersAnswer answer = stage.act(&Player::play);
  for (const Player& player : *answer.view->players) EXPECT_EQ(player.anchor_us, answer.now_us);
  const Show show = show_at(*answer.view, answer.now_us + 123'456);
  for (const ActorShow& actor : show.actors) EXPECT_DOUBLE_EQ(actor.time_s, 0.123456);
}

TEST(StagePlayers, OfOneActorLeaveTheOthersAlone) {
  RunningStage stage({scene_of("main", {square_actor("a"), square_actor("b")})});
  stage.start();
  const PlayersAnswer answer = stage.act(&Player::play, "b");
  EXPECT_EQ(answer.concerned, (std::vector<std::size_t>{1}));
  EXPECT_FALSE(answer.view->players->at(0).playing);
  EXPECT_TRUE(answer.view->players->at(1).playing);
  stage.wait_for(Kind::PlayersChanged, 1);
  EXPECT_EQ(stage.told().back().players, (std::vector<std::size_t>{1})) << "only those concerned are named";
}

TEST(StagePlayers, AnErrorChangesNoneOfThem) {
  RunningStage stage({scene_of("main", {square_actor("a"), square_actor("b")})});
  stage.start();
  const SceneViewPtr before = stage.view();
  const auto answer = stage.change_players("main", [](const PlayersTurn& turn) -> Result<std::vector<std::size_t>> {
    turn.players[0].play({0.0, 2.0}, turn.now_us);
    return fail(ErrorCode::NotFound, "the second lacks the clip", "params.clip");
  });
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::NotFound);
  EXPECT_EQ(stage.view(), before);
  EXPECT_FALSE(stage.view()->players->at(0).playing);
  EXPECT_EQ(stage.count(Kind::PlayersChanged), 0U);
}

TEST(StagePlayers, OfASceneThatIsNotThereAreNotFound) {
  RunningStage stage;
  stage.start();
  const auto answer = stage.change_players("nowhere", RunningStage::every_player(&Player::play));
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::NotFound);
  EXPECT_EQ(answer.error().path, "params.scene");
}

TEST(StagePlayers, AreNotHeldUpByTheDisk) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  stage.store.hold();
  auto edit = stage.edit_later({"main", "test.edit", {}, {}}, RunningStage::applies(SetActor{"square", nullptr}));
  stage.store.wait_for_commits(1);
  EXPECT_TRUE(stage.act(&Player::play).view->players->at(0).playing) << "over the document as it is published";
  stage.store.release();
  EXPECT_TRUE(RunningStage::wait(std::move(edit)));
  EXPECT_TRUE(stage.view()->players->empty());
}

TEST(StagePlayers, GoOnThroughAnEditOfAnotherActor) {
  RunningStage stage({scene_of("main", {square_actor("a"), square_actor("b")})});
  stage.start();
  stage.act(&Player::play);
  const Player before = stage.view()->players->at(0);
  ASSERT_TRUE(stage.edit(SetActor{"b", nullptr}));
  ASSERT_TRUE(stage.edit(SetActor{"c", square_actor("c"), 0}));
  ASSERT_EQ(stage.view()->players->size(), 2U);
  const Player& after = stage.view()->players->at(1);
  EXPECT_EQ(after.actor, "a");
  EXPECT_TRUE(after.playing);
  EXPECT_EQ(after.anchor_us, before.anchor_us);
  EXPECT_EQ(after.jumps, before.jumps);
  EXPECT_EQ(stage.view()->players->at(0).actor, "c") << "players stand in the order of the actors";
}

TEST(StagePlayers, GoOnThroughChangesThatLeaveTheClipsLength) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  stage.act(&Player::play);
  const Player before = stage.view()->players->at(0);
  ASSERT_TRUE(stage.edit(keyframe_at(stage, "square", 0.5, 50)));
  ASSERT_TRUE(stage.edit(SetActorSettings{"square", test::with_visible(false)}));
  const Player& after = stage.view()->players->at(0);
  EXPECT_EQ(after.anchor_us, before.anchor_us);
  EXPECT_EQ(after.anchor_phase_s, before.anchor_phase_s);
}

TEST(StagePlayers, KeepTheirTimeWhenTheClipGrowsUnderThem) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  const PlayersAnswer started = stage.act([](Player& player, const PlayRange& range, ClockUs now_us) {
    player.seek(range, 1.5, now_us);
    player.set_speed(range, 1e-6, now_us);
    player.play(range, now_us);
  });
  ASSERT_TRUE(stage.edit(keyframe_at(stage, "square", 40.0, 50)));
  const Player& player = stage.view()->players->at(0);
  const model::ActorPtr actor = stage.view()->scene->actors[0];
  EXPECT_DOUBLE_EQ(player.range_of(*actor->clips[0]).out_s, 40.0);
  const ActorShow show = show_actor(actor, player, player.anchor_us + 2'000'000);
  const double clock_s = seconds_between(started.now_us, player.anchor_us + 2'000'000);
  EXPECT_NEAR(show.time_s, 1.5 + 1e-6 * clock_s, 1e-9);
  EXPECT_TRUE(show.moving);
}

TEST(StagePlayers, AreBroughtIntoAClipThatShrank) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  stage.act([](Player& player, const PlayRange& range, ClockUs now_us) {
    player.set_loop(range, Loop::Once, now_us);
    player.seek(range, 1.5, now_us);
  });
  ASSERT_TRUE(stage.edit(SetKeyframe{"square", "default", 3, {}}));
  EXPECT_DOUBLE_EQ(show_at(*stage.view(), steady_now_us()).actors[0].time_s, 1.0);
}

TEST(StagePlayers, OfAClipThatWasRemovedRestAtTheFirstOnesStart) {
  for (const double speed : {1.0, -1.0}) {
    RunningStage stage({scene_of("main", {square_actor("square", {{.name = "first"}, {.name = "second", .first_id = 10}})})});
    stage.start();
    stage.act([&](Player& player, const PlayRange& range, ClockUs now_us) {
      player.set_speed(range, speed, now_us);
      player.change_clip(*stage.view()->scene->actors[0]->clips[1], now_us);
      player.play(range, now_us);
    });
    const std::uint64_t jumps = stage.view()->players->at(0).jumps;
    ASSERT_TRUE(stage.edit(SetClip{"square", "second", nullptr}));
    const Player& player = stage.view()->players->at(0);
    EXPECT_EQ(player.clip, "first");
    EXPECT_FALSE(player.playing);
    EXPECT_GT(player.jumps, jumps);
    EXPECT_EQ(show_at(*stage.view(), steady_now_us()).actors[0].time_s, 0.0);
  }
}

TEST(StagePlayers, OfAnActorThatUndoBringsBackAreFresh) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  stage.act(&Player::play);
  ASSERT_TRUE(stage.edit(SetActor{"square", nullptr}));
  EXPECT_TRUE(stage.view()->players->empty());
  ASSERT_TRUE(stage.undo());
  ASSERT_EQ(stage.view()->players->size(), 1U);
  const Player& player = stage.view()->players->at(0);
  EXPECT_EQ(player.actor, "square");
  EXPECT_EQ(player.clip, "default");
  EXPECT_FALSE(player.playing);
  EXPECT_EQ(show_at(*stage.view(), steady_now_us()).actors[0].time_s, 0.0);
}

TEST(StagePlayers, OfAnotherModelUnderTheSameNameAreFresh) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  stage.act(&Player::play);
  ASSERT_TRUE(stage.edit(SetActor{"square", square_actor("square")}));
  EXPECT_FALSE(stage.view()->players->at(0).playing);
}

TEST(StagePlayers, ThatLoseTheirClipAreNamedToTheListener) {
  RunningStage stage({scene_of("main", {square_actor("a", {{.name = "first"}, {.name = "second", .first_id = 10}}),
                                        square_actor("b", {{.name = "first"}, {.name = "second", .first_id = 10}})})});
  stage.start();
  stage.act([&](Player& player, const PlayRange&,
                ClockUs now_us) { player.change_clip(*stage.view()->scene->actors[1]->clips[1], now_us); },
            "b");
  stage.wait_for(Kind::PlayersChanged, 1);
  ASSERT_TRUE(stage.edit(SetClip{"a", "second", nullptr}));  // nobody is on it
  ASSERT_TRUE(stage.edit(SetClip{"b", "second", nullptr}));
  stage.wait_for(Kind::Edited, 2);
  EXPECT_EQ(stage.count(Kind::PlayersChanged), 2U);
  for (const auto& t : stage.told()) {
    if (t.kind != Kind::PlayersChanged) continue;
    EXPECT_EQ(t.players, (std::vector<std::size_t>{1}));
  }
}

/// The listener's calls about players, in order, as (kind, index) pairs.
std::vector<std::pair<Kind, std::size_t>> about_players(const RunningStage& stage) {
  std::vector<std::pair<Kind, std::size_t>> calls;
  for (const auto& t : stage.told()) {
    if (t.kind != Kind::PlayersChanged && t.kind != Kind::PlayerEnded) continue;
    for (const std::size_t i : t.players) calls.emplace_back(t.kind, i);
  }
  return calls;
}

TEST(StageEnd, IsToldOnceAfterThePlayersChange) {
  RunningStage stage({scene_of("main", {square_actor("square", {{.keys = 2, .spacing_s = 0.01}})})});
  stage.start();
  for (std::size_t run = 1; run <= 3; ++run) {
    stage.forget();
    const ClockUs started_us = stage.act(&play_once).now_us;
    stage.wait_for(Kind::PlayerEnded, 1);
    stage.settle();
    EXPECT_EQ(about_players(stage), (std::vector<std::pair<Kind, std::size_t>>{
                                        {Kind::PlayersChanged, 0}, {Kind::PlayersChanged, 0}, {Kind::PlayerEnded, 0}}))
        << "in run " << run;
    const auto told = stage.told();
    EXPECT_FALSE(told.back().view->players->at(0).playing);
    EXPECT_GE(told[told.size() - 2].at_us, started_us + 10'000);
    EXPECT_EQ(stage.view(), told.back().view) << "it was published before it was told";
    EXPECT_EQ(show_at(*stage.view(), steady_now_us()).actors[0].time_s, 0.01);
  }
}

TEST(StageEnd, ComesForEachActorOfTheSceneAtTheSameTime) {
  RunningStage stage({scene_of(
      "main", {square_actor("a", {{.keys = 2, .spacing_s = 0.01}}), square_actor("b", {{.keys = 2, .spacing_s = 0.01}})})});
  stage.start();
  stage.act(&play_once);
  stage.wait_for(Kind::PlayerEnded, 2);
  stage.settle();
  EXPECT_EQ(about_players(stage), (std::vector<std::pair<Kind, std::size_t>>{{Kind::PlayersChanged, 0},
                                                                             {Kind::PlayersChanged, 1},
                                                                             {Kind::PlayersChanged, 0},
                                                                             {Kind::PlayersChanged, 1},
                                                                             {Kind::PlayerEnded, 0},
                                                                             {Kind::PlayerEnded, 1}}));
}

TEST(StageEnd, OfThoseNoticedTogetherTheFirstIsToldFirst) {
  RunningStage stage({scene_of("main", {square_actor("late", {{.keys = 2, .spacing_s = 0.02}}),
                                        square_actor("early", {{.keys = 2, .spacing_s = 0.01}})})});
  stage.start();
  stage->change_players("main", RunningStage::every_player(&play_once), [](const Result<PlayersAnswer>&) {
    const ClockUs both_are_over_us = steady_now_us() + 30'000;
    while (steady_now_us() < both_are_over_us) continue;  // the strand is busy meanwhile
  });
  stage.wait_for(Kind::PlayerEnded, 2);
  stage.settle();
  std::vector<std::size_t> ended;
  for (const auto& t : stage.told()) {
    if (t.kind == Kind::PlayerEnded) ended.push_back(t.players[0]);
  }
  EXPECT_EQ(ended, (std::vector<std::size_t>{1, 0}));
}

TEST(StageEnd, ComesOnceForEachPlayerOfAllScenes) {
  RunningStage stage({scene_of("main", {square_actor("early", {{.keys = 2, .spacing_s = 0.001}}),
                                        square_actor("late", {{.keys = 2, .spacing_s = 0.03}})}),
                      scene_of("other", {square_actor("middle", {{.keys = 2, .spacing_s = 0.01}})})});
  stage.start();
  stage.act(&play_once, {}, "other");
  stage.act(&play_once);
  stage.wait_for(Kind::PlayerEnded, 3);
  stage.settle();
  std::vector<std::string> ended;
  for (const auto& t : stage.told()) {
    if (t.kind == Kind::PlayerEnded) ended.push_back(t.view->players->at(t.players[0]).actor);
  }
  ASSERT_EQ(ended.size(), 3U);
  const auto place = [&](const char* actor) { return std::find(ended.begin(), ended.end(), actor); };
  EXPECT_LT(place("early"), place("late"));
  EXPECT_NE(place("middle"), ended.end());
}

TEST(StageEnd, OfAOnceWithNothingToPlayComesAsItStarts) {
  RunningStage stage({scene_of("main", {square_actor("still", {{.keys = 1}}), square_actor("empty", {{.keys = 0}})})});
  stage.start();
  for (std::size_t run = 1; run <= 2; ++run) {
    stage.forget();
    stage.act(&play_once);
    stage.settle();
    EXPECT_EQ(about_players(stage), (std::vector<std::pair<Kind, std::size_t>>{{Kind::PlayersChanged, 0},
                                                                               {Kind::PlayersChanged, 1},
                                                                               {Kind::PlayersChanged, 0},
                                                                               {Kind::PlayersChanged, 1},
                                                                               {Kind::PlayerEnded, 0},
                                                                               {Kind::PlayerEnded, 1}}));
    EXPECT_FALSE(stage.view()->players->at(0).playing);
  }
}

TEST(StageEnd, DoesNotComeToAPlayerThatWasPausedOrTurned) {
  RunningStage stage({scene_of("main", {square_actor("paused", {{.keys = 2, .spacing_s = 0.02}}),
                                        square_actor("witness", {{.keys = 2, .spacing_s = 0.04}})})});
  stage.start();
  stage.act(&play_once);
  stage.act([](Player& player, const PlayRange& range, ClockUs now_us) { player.pause(range, now_us); }, "paused");
  stage.wait_for(Kind::PlayerEnded, 1);  // the witness's, later than the other's would have been
  stage.settle();
  for (const auto& t : stage.told()) {
    if (t.kind == Kind::PlayerEnded && !t.view->players->empty()) {
      const std::string& actor = t.view->players->at(t.players[0]).actor;
      // On a machine that was away for 20 ms between the two calls it did run out first.
      if (actor == "paused") {
        EXPECT_DOUBLE_EQ(show_at(*stage.view(), steady_now_us()).actors[0].time_s, 0.02);
      }
    }
  }
}

TEST(StageEnd, ComesAtOnceWhenAnEditTakesTheRestOfTheClip) {
  RunningStage stage({scene_of("main", {square_actor("square", {{.keys = 3, .spacing_s = 1000.0}})})});
  stage.start();
  stage.act([](Player& player, const PlayRange& range, ClockUs now_us) {
    player.seek(range, 1500.0, now_us);
    play_once(player, range, now_us);
  });
  ASSERT_TRUE(stage.edit(SetKeyframe{"square", "default", 3, {}}));
  stage.wait_for(Kind::PlayerEnded, 1);
  EXPECT_EQ(show_at(*stage.view(), steady_now_us()).actors[0].time_s, 1000.0);
}

TEST(StageEnd, WaitsWhenAnEditMakesTheClipLonger) {
  RunningStage stage({scene_of("main", {square_actor("square", {{.keys = 2, .spacing_s = 1000.0}})})});
  stage.start();
  const ClockUs started_us = stage.act(&play_once).now_us;
  ASSERT_TRUE(stage.edit(keyframe_at(stage, "square", 3000.0, 50)));
  const Player& player = stage.view()->players->at(0);
  const auto end_us = player.end_us(player.range_of(*stage.view()->scene->actors[0]->clips[0]));
  ASSERT_TRUE(end_us);
  EXPECT_NEAR(static_cast<double>(*end_us - started_us), 3000e6, 2.0);
  EXPECT_EQ(stage.count(Kind::PlayerEnded), 0U);
}

TEST(StageEnd, FarBeyondAnyTimerNeverComes) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  for (const double speed : {1e-9, 1e-12, 1e-300, 3e-10}) {
    stage.act([&](Player& player, const PlayRange& range, ClockUs now_us) {
      player.set_speed(range, speed, now_us);
      play_once(player, range, now_us);
    });
  }
  stage.settle();
  EXPECT_EQ(stage.count(Kind::PlayerEnded), 0U);
  EXPECT_TRUE(stage.view()->players->at(0).playing);
}

}  // namespace
}  // namespace tweend::stage
