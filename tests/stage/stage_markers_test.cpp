#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tests/stage/players.hpp"
#include "tests/support/running_stage.hpp"

// What a listener is told of markers by a stage that runs: each crossing once, in order, whatever happens meanwhile.

namespace tweend::stage {
namespace {

using test::RunningStage;
using test::scene_of;
using test::square_actor;
using Kind = RunningStage::Kind;

model::ActorPtr marked(const char* name, std::vector<double> times_s) {
  auto actor = std::make_shared<model::Actor>(*square_actor(name));
  auto clip = std::make_shared<model::Clip>(*actor->clips[0]);
  auto markers = std::make_shared<std::vector<model::Marker>>();
  for (const double t : times_s) markers->push_back({100 + static_cast<model::KeyframeId>(markers->size()), t, "step"});
  clip->markers = markers;
  actor->clips[0] = clip;
  return actor;
}

std::vector<MarkerCrossed> crossed(const RunningStage& stage) {
  std::vector<MarkerCrossed> all;
  for (const auto& told : stage.told()) all.insert(all.end(), told.crossed.begin(), told.crossed.end());
  return all;
}

void play_once(Player& player, const PlayRange& range, ClockUs now_us) {
  player.set_loop(range, Loop::Once, now_us);
  player.set_speed(range, 100.0, now_us);
  player.play(range, now_us);
}

TEST(StageMarkers, AreToldToNobodyWhereNobodyListens) {
  RunningStage stage({scene_of("main", {marked("square", {0.5})})});
  stage.start();
  stage.act(play_once);
  stage.wait_for(Kind::PlayerEnded, 1);
  EXPECT_TRUE(crossed(stage).empty());
  // Nor afterwards, to those who come later.
  stage->set_audience(true);
  stage.settle();
  EXPECT_TRUE(crossed(stage).empty());
}

TEST(StageMarkers, AreToldBeforeTheEndThatComesAfterThem) {
  RunningStage stage({scene_of("main", {marked("square", {0.0, 0.5, 2.0})})});
  stage.start();
  stage->set_audience(true);
  const ClockUs begin = stage.act(play_once).now_us;
  stage.wait_for(Kind::PlayerEnded, 1);
  const auto all = crossed(stage);
  ASSERT_EQ(all.size(), 3U);
  const std::vector<ClockUs> at{begin, begin + 5'000, begin + 20'000};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(all[i].actor, "square");
    EXPECT_EQ(all[i].clip, "default");
    EXPECT_EQ(all[i].marker.id, 100 + static_cast<model::KeyframeId>(i));
    EXPECT_EQ(all[i].at_us, at[i]);
  }
  const auto told = stage.told();
  const auto last_mark = std::find_if(told.rbegin(), told.rend(), [](const auto& t) { return t.kind == Kind::MarkersCrossed; });
  const auto end = std::find_if(told.rbegin(), told.rend(), [](const auto& t) { return t.kind == Kind::PlayerEnded; });
  EXPECT_GT(last_mark - told.rbegin(), end - told.rbegin());
}

TEST(StageMarkers, OfASeekAreNone) {
  RunningStage stage({scene_of("main", {marked("square", {0.5})})});
  stage.start();
  stage->set_audience(true);
  stage.act([](Player& p, const PlayRange& r, ClockUs now) { p.seek(r, 0.5, now); });
  stage.act([](Player& p, const PlayRange& r, ClockUs now) { p.seek(r, 1.5, now); });
  stage.settle();
  EXPECT_TRUE(crossed(stage).empty());
}

TEST(StageMarkers, AreCrossedOnceHoweverManyChangesThereAre) {
  RunningStage stage({scene_of("main", {marked("square", {0.5})})});
  stage.start();
  stage->set_audience(true);
  const ClockUs begin = stage
                            .act([](Player& p, const PlayRange& r, ClockUs now) {
                              p.set_speed(r, 400.0, now);
                              p.play(r, now);
                            })
                            .now_us;
  ClockUs end = begin;
  while (end < begin + 200'000) {  // each rebases the player in the midst of its run
    end = stage.act([](Player& p, const PlayRange& r, ClockUs now) { p.set_speed(r, 400.0, now); }).now_us;
    ASSERT_TRUE(stage.edit(SetSceneSettings{test::with_grid(true)}));
  }
  end = stage.act(&Player::pause).now_us;
  const auto all = crossed(stage);
  const double passes = 400.0 * seconds_between(begin, end) / 2.0;
  EXPECT_NEAR(static_cast<double>(all.size()), passes + 0.25, 1.0);
  for (std::size_t k = 0; k < all.size(); ++k) {
    // The first at 0.5 s of 400 a second, then one each 2 s; an anchor is at most a microsecond's rounding off.
    EXPECT_NEAR(static_cast<double>(all[k].at_us - begin), 1'250.0 + 5'000.0 * static_cast<double>(k), 2.0);
  }
}

TEST(StageMarkers, ThatAreAddedOrRemovedMeanwhileCountFromThen) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  stage->set_audience(true);
  stage.act([](Player& p, const PlayRange& r, ClockUs now) {
    p.set_speed(r, 100.0, now);
    p.play(r, now);
  });
  ASSERT_TRUE(stage.edit(SetMarker{"square", "default", 7, model::Marker{7, 1.0, "step"}}));
  stage.wait_for(Kind::MarkersCrossed, 3);
  EXPECT_EQ(crossed(stage).front().marker.id, 7);
  ASSERT_TRUE(stage.undo());
  const std::size_t told = crossed(stage).size();
  stage.act(&Player::pause);
  EXPECT_EQ(crossed(stage).size(), told);
}

TEST(StageMarkers, OfSeveralActorsComeInOrder) {
  RunningStage stage({scene_of("main", {marked("a", {0.3, 0.9}), marked("b", {0.1, 0.6, 1.1})})});
  stage.start();
  stage->set_audience(true);
  stage.act([](Player& p, const PlayRange& r, ClockUs now) {
    p.set_speed(r, 1'000.0, now);
    p.play(r, now);
  });
  stage.wait_for(Kind::MarkersCrossed, 4);
  const auto all = crossed(stage);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.at_us < y.at_us; }));
}

TEST(StageMarkers, FasterThanCanBeToldAreCutNotCollected) {
  RunningStage stage({scene_of("main", {marked("a", {0.5})})});
  stage.start();
  stage->set_audience(true);
  stage.act([](Player& p, const PlayRange& r, ClockUs now) {
    p.set_speed(r, 1e9, now);
    p.play(r, now);
  });
  stage.wait_for(Kind::MarkersCrossed, 3);
  stage.act(&Player::pause);
  for (const auto& told : stage.told()) EXPECT_LE(told.crossed.size(), 4'096U);
}

TEST(StageQueue, TellsOfEachClipAndOfTheEnd) {
  // The second clip takes hours: however late the timer moves the queue on, it does not reach the end as well.
  constexpr double kHours_s = 1e6;
  const model::ActorPtr actor =
      square_actor("square", {{.name = "a", .keys = 2}, {.name = "b", .keys = 2, .spacing_s = kHours_s, .first_id = 10}});
  RunningStage stage({scene_of("main", {actor})});
  stage.start();
  const auto answer = stage.change_players("main", [](const PlayersTurn& turn) -> Result<std::vector<std::size_t>> {
    turn.players[0].speed = 50.0;
    turn.players[0].start_queue(*turn.scene.actors[0], {{.clip = "a"}, {.clip = "b", .repeat = 2}}, turn.now_us);
    return std::vector<std::size_t>{0};
  });
  ASSERT_TRUE(answer);
  stage.wait_for(Kind::PlayersChanged, 2);
  stage->post([&stage, end_us = answer->now_us + 50'000 * kSecond] { stage->advance(end_us); });
  stage.wait_for(Kind::PlayerEnded, 1);
  std::vector<std::string> clips;
  for (const auto& told : stage.told()) {
    if (told.kind == Kind::PlayersChanged) clips.push_back(told.view->players->at(0).clip);
  }
  EXPECT_EQ(clips, (std::vector<std::string>{"a", "b", "b"})) << "begun, moved on, ended";
  const Player player = stage.view()->players->at(0);
  EXPECT_FALSE(player.playing);
  EXPECT_EQ(player.read({0.0, kHours_s}, steady_now_us()).time_s, kHours_s);
}

TEST(StageLayers, FadeInAsTheEditIsPublished) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  const model::Layer layer{"l", "default", 1.0F, false, nullptr, nullptr};
  const auto set = [&](Transaction& t) -> RunningStage::Answer {
    t.apply(SetLayer{"square", "l", layer});
    t.fade_layer({"square", "l", 10.0});
    return "";
  };
  ASSERT_TRUE(stage.edit({"main", "layer.set", {}, {}}, set));
  const Player player = stage.view()->players->at(0);
  ASSERT_EQ(player.layer_fades.size(), 1U);
  EXPECT_EQ(player.layer_fades[0].from_weight, 0.0F);
  ASSERT_TRUE(stage.undo());
  EXPECT_TRUE(stage.view()->scene->actors[0]->layers.empty());
  EXPECT_TRUE(stage.view()->players->at(0).layer_fades.empty());
}

}  // namespace
}  // namespace tweend::stage
