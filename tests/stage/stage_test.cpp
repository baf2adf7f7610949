#include "server/stage/stage.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <future>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/running_stage.hpp"

namespace tweend::stage {
namespace {

using test::RunningStage;
using test::scene_of;
using test::square_actor;

TEST(StageStart, MakesTheSceneMain) {
  RunningStage stage;
  stage.start();
  ASSERT_TRUE(stage.view());
  EXPECT_EQ(stage.view()->scene->name, "main");
  EXPECT_EQ(stage.revision(), 0U);
  EXPECT_TRUE(stage.view()->scene->actors.empty());
  EXPECT_EQ(stage.metrics.scenes.load(), 1);
}

TEST(StageStart, PublishesWhatTheStoreHas) {
  auto main = std::make_shared<model::Scene>(*scene_of("main", {square_actor("square")}));
  main->revision = 30;
  RunningStage stage({main, scene_of("other", {square_actor("a"), square_actor("b")})});
  stage.start();
  EXPECT_EQ(stage.view()->scene, main);
  EXPECT_EQ(stage->head("main"), main);
  ASSERT_TRUE(stage.view("other"));
  ASSERT_EQ(stage.view("other")->players->size(), 2U);
  EXPECT_EQ((*stage.view("other")->players)[1].actor, "b");
  EXPECT_EQ((*stage.view("other")->players)[1].clip, "default");
  EXPECT_EQ(stage.metrics.scenes.load(), 2);
  EXPECT_EQ(stage.metrics.actors.load(), 3);
  EXPECT_EQ(stage.count(RunningStage::Kind::Published), 2U);
}

TEST(StageStart, FailsWithTheStore) {
  RunningStage stage;
  stage.store.fail_load();
  const Status status = stage->start(stage);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::Unavailable);
}

TEST(StageStop, AnswersEverythingThatWasPostedBefore) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  std::vector<std::future<RunningStage::Answer>> edits;
  std::vector<std::future<Result<PlayersAnswer>>> turns;
  for (int i = 0; i < 200; ++i) {
    edits.push_back(
        stage.edit_later({"main", "test.edit", {}, {}}, RunningStage::applies(SetSceneSettings{test::with_grid(i % 2 == 0)})));
    turns.push_back(stage.change_players_later("main", RunningStage::every_player(&Player::play)));
  }
  stage.stop();
  for (std::size_t i = 0; i < edits.size(); ++i) {
    ASSERT_EQ(edits[i].wait_for(std::chrono::seconds(0)), std::future_status::ready);
    EXPECT_EQ(*edits[i].get(), std::to_string(i + 1));
    ASSERT_EQ(turns[i].wait_for(std::chrono::seconds(0)), std::future_status::ready);
    EXPECT_TRUE(turns[i].get());
  }
  EXPECT_EQ(stage.store.durable("main")->revision, 200U);
}

TEST(StageStop, AnswersEditsWhoseCommitIsUnderWayOrFails) {
  RunningStage stage;
  stage.start();
  stage.store.hold();
  auto under_way = stage.edit_later({"main", "test.edit", {}, {}}, RunningStage::applies(SetSceneSettings{}));
  stage.store.wait_for_commits(1);
  auto waiting = stage.edit_later({"main", "test.edit", {}, {}}, RunningStage::applies(SetSceneSettings{}));
  stage.store.fail_next(1);
  std::thread release([&] { stage.store.release(); });
  stage->stop();
  release.join();
  for (auto* answer : {&under_way, &waiting}) {
    ASSERT_EQ(answer->wait_for(std::chrono::seconds(0)), std::future_status::ready);
    EXPECT_FALSE(answer->get());
  }
}

TEST(StageStop, MayComeTwiceAndWithoutAStart) {
  RunningStage stage;
  stage->stop();
  stage.start();
  stage->stop();
  stage->stop();
}

TEST(StagePost, RunsTasksInTheirOrderOnOneThread) {
  RunningStage stage;
  stage.start();
  std::vector<int> order;  // the strand's own: no lock
  for (int i = 0; i < 1000; ++i) stage->post([&order, i] { order.push_back(i); });
  stage.settle();
  ASSERT_EQ(order.size(), 1000U);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
}

// Readers look all the time while edits of several clients are committed in groups, some of which fail.
TEST(StageView, NeverShowsAnEditThatIsNotDurable) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  std::atomic<bool> done{false};
  std::atomic<std::uint64_t> seen_early{0};
  std::vector<std::thread> readers;
  for (int i = 0; i < 2; ++i) {
    readers.emplace_back([&] {
      std::uint64_t last_serial = 0;
      while (!done) {
        const SceneViewPtr view = stage.view();
        // Looked up later, what is durable can only be newer.
        if (view->scene->revision > stage.store.durable("main")->revision) ++seen_early;
        if (view->serial < last_serial) ++seen_early;
        last_serial = view->serial;
        std::this_thread::yield();
      }
    });
  }
  for (std::size_t round = 0; round < 60; ++round) {
    if (round % 3 == 0) stage.store.fail_next(1);
    std::vector<std::future<RunningStage::Answer>> answers;
    for (int i = 0; i < 5; ++i) {
      answers.push_back(stage.edit_later({"main", "test.edit", {}, {}}, RunningStage::applies(SetActorSettings{"square", {}})));
    }
    for (auto& answer : answers) {
      const RunningStage::Answer revision = RunningStage::wait(std::move(answer));
      if (revision) {
        EXPECT_GE(stage.revision(), std::stoull(*revision)) << "what was answered can be read";
      }
    }
  }
  done = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(seen_early, 0U);
}

}  // namespace
}  // namespace tweend::stage
