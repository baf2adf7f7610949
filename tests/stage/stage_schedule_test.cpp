#include <gtest/gtest.h>

#include <future>
#include <string>
#include <utility>
#include <vector>

#include "tests/stage/players.hpp"
#include "tests/support/running_stage.hpp"

// Commands that wait for their reading: exact as of it, in their order, and gone with what they were about.

namespace tweend::stage {
namespace {

using test::RunningStage;
using test::scene_of;
using test::square_actor;
using Kind = RunningStage::Kind;
using Answer = RunningStage::Answer;

constexpr ClockUs kNever = 3'600 * kSecond;  // from now: no test waits for it

class StageSchedule : public ::testing::Test {
 protected:
  StageSchedule() : stage({scene_of("main", {square_actor("square")}), scene_of("side", {square_actor("square")})}, limits()) {
    stage.start();
  }
  static Limits limits() {
    Limits l;
    l.scheduled_commands = 3;
    return l;
  }

  TimedAct acts(RunningStage::Act act, std::string scene = "main") {
    return [this, act = std::move(act), scene = std::move(scene)](ClockUs as_of_us, const EditDone& done) {
      stage->carry_out(scene, RunningStage::every_player(act), as_of_us, [&](const Result<PlayersAnswer>& answer) {
        if (!answer) return done(answer.error());
        done("carried out " + std::to_string(answer->now_us));
      });
    };
  }
  Answer schedule(Timing timing, TimedAct act, const std::string& scene = "main") {
    std::promise<Answer> answered;
    stage->schedule(
        scene, "playback.test", timing, std::move(act), [](ScheduledId id, ClockUs) { return std::to_string(id); },
        [&](Answer answer) { answered.set_value(std::move(answer)); });
    return answered.get_future().get();
  }
  Status cancel(ScheduledId id) {
    std::promise<Status> answered;
    stage->cancel(id, [&](Status status) { answered.set_value(std::move(status)); });
    return answered.get_future().get();
  }
  Result<std::vector<Scheduled>> list(const std::string& scene = "main") {
    std::promise<Result<std::vector<Scheduled>>> answered;
    stage->list_scheduled(scene, [&](Result<std::vector<Scheduled>> l) { answered.set_value(std::move(l)); });
    return answered.get_future().get();
  }
  /// The strand finds that this reading is past, as if its timer had been so late.
  void tick(ClockUs now_us) {
    stage->post([this, now_us] { stage->advance(now_us); });
  }
  Player player() { return stage.view()->players->at(0); }

  RunningStage stage;
};

TEST_F(StageSchedule, RefusesWhatIsTooLateOnlyIfAskedTo) {
  const ClockUs past = steady_now_us() - 1;
  const Answer refused = schedule({past, true}, acts(&Player::play));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::InvalidParams);
  EXPECT_EQ(refused.error().path, "params.at_us");
  EXPECT_FALSE(player().playing);
  const Answer late = schedule({past, false}, acts(&Player::play));
  ASSERT_TRUE(late);
  EXPECT_TRUE(late->starts_with("carried out"));
  EXPECT_TRUE(player().playing);
  EXPECT_GE(player().anchor_us, past + 1) << "as of now";
}

TEST_F(StageSchedule, RefusesASceneThatIsNotThere) {
  EXPECT_EQ(schedule({steady_now_us() + kNever, false}, acts(&Player::play), "nowhere").error().code, ErrorCode::NotFound);
  EXPECT_EQ(list("nowhere").error().code, ErrorCode::NotFound);
}

TEST_F(StageSchedule, HasALimit) {
  const ClockUs at = steady_now_us() + kNever;
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(schedule({at, false}, acts(&Player::play)));
  EXPECT_EQ(schedule({at, false}, acts(&Player::play)).error().code, ErrorCode::Limit);
  EXPECT_EQ(list()->size(), 3U);
  EXPECT_TRUE(cancel(list()->front().id));
  EXPECT_TRUE(schedule({at, false}, acts(&Player::play)));
}

TEST_F(StageSchedule, IsExactHoweverLateTheTick) {
  const ClockUs at = steady_now_us() + kNever;
  ASSERT_TRUE(schedule({at, false}, acts(&Player::play)));
  EXPECT_FALSE(player().playing);
  tick(at + 5'000);
  stage.wait_for(Kind::PlayersChanged, 1);
  EXPECT_TRUE(player().playing);
  EXPECT_EQ(player().anchor_us, at);
  EXPECT_EQ(stage.told().back().at_us, at);
  EXPECT_TRUE(list()->empty());
}

TEST_F(StageSchedule, CarriesOutInTheOrderOfReadingsAndThenOfArrival) {
  const ClockUs at = steady_now_us() + kNever;
  const auto speed = [&](double value) {
    return acts([value](Player& p, const PlayRange& r, ClockUs now) { p.set_speed(r, value, now); });
  };
  ASSERT_TRUE(schedule({at + 10, false}, speed(3.0)));
  ASSERT_TRUE(schedule({at, false}, speed(1.0)));
  ASSERT_TRUE(schedule({at, false}, speed(2.0)));
  const auto waiting = list();
  ASSERT_EQ(waiting->size(), 3U);
  EXPECT_EQ((*waiting)[0].id, 2);
  EXPECT_EQ((*waiting)[1].id, 3);
  EXPECT_EQ((*waiting)[2].id, 1);
  EXPECT_EQ((*waiting)[2].method, "playback.test");
  tick(at + 10);
  stage.wait_for(Kind::PlayersChanged, 3);
  std::vector<double> speeds;
  for (const auto& told : stage.told()) {
    if (told.kind == Kind::PlayersChanged) speeds.push_back(told.view->players->at(0).speed);
  }
  EXPECT_EQ(speeds, (std::vector<double>{1.0, 2.0, 3.0}));
}

/// A command for now never sees a player as it was before what was due earlier.
TEST_F(StageSchedule, ComesBeforeWhatIsAskedLater) {
  const ClockUs at = steady_now_us() + 100'000;
  ASSERT_TRUE(schedule({at, false}, acts(&Player::play)));
  std::promise<bool> seen;
  stage->post([&] {
    while (steady_now_us() < at) {
    }
    // Posted before the timer can have its turn.
    stage->change_players(
        "main",
        [&](const PlayersTurn& turn) -> Result<std::vector<std::size_t>> {
          seen.set_value(turn.players[0].playing);
          return std::vector<std::size_t>{};
        },
        [](const Result<PlayersAnswer>&) {});
  });
  EXPECT_TRUE(seen.get_future().get());
}

TEST_F(StageSchedule, CanBeCancelledOnce) {
  const Answer id = schedule({steady_now_us() + kNever, false}, acts(&Player::play));
  EXPECT_TRUE(cancel(std::stoll(*id)));
  const Status again = cancel(std::stoll(*id));
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, ErrorCode::NotFound);
  EXPECT_EQ(again.error().path, "params.scheduled");
  EXPECT_TRUE(list()->empty());
}

TEST_F(StageSchedule, TellsWhenItFails) {
  const TimedAct fails = [](ClockUs, const EditDone& done) {
    done(fail(ErrorCode::NotFound, "no such actor", "params.actor"));
  };
  const ClockUs at = steady_now_us() + kNever;
  ASSERT_TRUE(schedule({at, false}, fails));
  tick(at);
  stage.wait_for(Kind::ScheduleFailed, 1);
  const auto told = stage.told().back();
  EXPECT_EQ(told.scene, "main");
  EXPECT_EQ(told.scheduled->id, 1);
  EXPECT_EQ(told.scheduled->method, "playback.test");
  EXPECT_EQ(told.error->code, ErrorCode::NotFound);
}

TEST_F(StageSchedule, DoesEditsAsOfTheirTime) {
  const TimedAct edits = [this](ClockUs, const EditDone& done) {
    stage->plan({"main", "camera.set", {}, {}}, RunningStage::applies(SetSceneSettings{test::with_grid(true)}), done);
  };
  ASSERT_TRUE(schedule({steady_now_us() + 100'000, false}, edits));
  stage.wait_for(Kind::Edited, 1);
  EXPECT_TRUE(stage.view()->scene->settings.grid);
  EXPECT_EQ(stage.told().back().edit->method, "camera.set");
  EXPECT_TRUE(stage.undo());
  EXPECT_FALSE(stage.view()->scene->settings.grid);
}

TEST_F(StageSchedule, GoesWithItsScene) {
  ASSERT_TRUE(schedule({steady_now_us() + kNever, false}, acts(&Player::play, "side"), "side"));
  ASSERT_TRUE(schedule({steady_now_us() + kNever, false}, acts(&Player::play)));
  EXPECT_EQ(list("side")->size(), 1U);
  ASSERT_TRUE(RunningStage::wait(stage.remove_later({"side", "scene.remove", {}, {}})));
  ASSERT_TRUE(RunningStage::wait(stage.create_later({"side", "scene.create", {}, {}})));
  EXPECT_TRUE(list("side")->empty());
  EXPECT_EQ(list()->size(), 1U);
}

}  // namespace
}  // namespace tweend::stage
