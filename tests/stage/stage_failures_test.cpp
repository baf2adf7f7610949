#include <gtest/gtest.h>

#include <future>
#include <string>
#include <utility>
#include <vector>

#include "server/stage/stage.hpp"
#include "tests/support/running_stage.hpp"

// What happens when the disk says no.

namespace tweend::stage {
namespace {

using test::RunningStage;
using test::scene_of;
using test::square_actor;
using test::square_at;
using Kind = RunningStage::Kind;
using Answer = RunningStage::Answer;

EditOptions named(const std::string& method, std::string retry_key = {}) { return {"main", method, {}, std::move(retry_key)}; }
SetSceneSettings ambient(float value) { return SetSceneSettings{test::with_ambient(value)}; }
float ambient_of(const RunningStage& stage) { return stage.view()->scene->settings.light.ambient; }

void expect_unavailable(const Answer& answer) {
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::Unavailable);
  EXPECT_EQ(answer.error().message, "the disk is full");
}

TEST(StageFailure, AnswersUnavailableAndChangesNothing) {
  RunningStage stage;
  stage.start();
  ASSERT_TRUE(stage.edit(ambient(1.0F)));
  const SceneViewPtr before = stage.view();
  stage.store.fail_next(1);
  expect_unavailable(stage.edit(ambient(2.0F)));
  EXPECT_EQ(stage.view(), before);
  EXPECT_EQ(stage->head("main"), before->scene) << "the head was dropped";
  EXPECT_EQ(stage.metrics.commit_failures_total.load(), 1);
  EXPECT_EQ(stage.count(Kind::Edited), 1U);
}

TEST(StageFailure, LetsTheNextEditWork) {
  RunningStage stage;
  stage.start();
  ASSERT_TRUE(stage.edit(ambient(1.0F)));
  stage.store.fail_next(2);
  expect_unavailable(stage.edit(ambient(2.0F)));
  expect_unavailable(stage.edit(ambient(2.0F)));
  EXPECT_EQ(*stage.edit(ambient(3.0F)), "2");
  EXPECT_EQ(ambient_of(stage), 3.0F);
  ASSERT_TRUE(stage.undo());
  EXPECT_EQ(ambient_of(stage), 1.0F) << "the lost edits left no trace in the history";
}

TEST(StageFailure, LosesEveryEditThatWaitsInAllScenes) {
  RunningStage stage({scene_of("main"), scene_of("other")});
  stage.start();
  stage.store.hold();
  std::vector<std::future<Answer>> lost;
  for (int i = 0; i < 5; ++i) {
    lost.push_back(stage.edit_later(named("test.edit"), RunningStage::applies(ambient(3.0F))));
    lost.push_back(stage.edit_later({"other", "test.edit", {}, {}}, RunningStage::applies(ambient(3.0F))));
  }
  stage.settle();
  stage.store.fail_next(1);
  stage.store.release();
  for (auto& answer : lost) expect_unavailable(RunningStage::wait(std::move(answer)));
  EXPECT_EQ(stage.revision(), 0U);
  EXPECT_EQ(stage.revision("other"), 0U);
  EXPECT_EQ(stage->head("other")->revision, 0U);
}

TEST(StageFailure, TakesTheEditsBuiltOnTheLostOneWithIt) {
  RunningStage stage;
  stage.start();
  stage.store.hold();
  auto lost = stage.edit_later(named("test.edit"), RunningStage::applies(ambient(1.0F)));
  stage.store.wait_for_commits(1);
  auto built_on_it = stage.edit_later(named("test.edit"), RunningStage::applies(ambient(2.0F)));
  stage.settle();
  stage.store.fail_next(1);
  stage.store.release();
  expect_unavailable(RunningStage::wait(std::move(lost)));
  expect_unavailable(RunningStage::wait(std::move(built_on_it)));
  EXPECT_EQ(stage.revision(), 0U);
  EXPECT_EQ(*stage.edit(ambient(3.0F)), "1");
  for (const auto& group : stage.store.groups()) EXPECT_EQ(group.size(), 1U) << "the second edit was never written";
}

// Edits are planned all the time while some commits fail: whatever is answered with success is there, in the order of the
// answers, and nothing else is.
TEST(StageFailure, InTheMidstOfManyEditsLosesOnlyWhatWasRefused) {
  RunningStage stage({scene_of("main", {square_actor("square", {{.keys = 1}})})});
  stage.start();
  std::vector<std::string> kept;
  for (int round = 0; round < 50; ++round) {
    std::vector<std::future<Answer>> answers;
    if (round % 2 == 0) stage.store.fail_next(1);
    for (int i = 0; i < 8; ++i) {
      const double time_s = 1.0 + round * 8 + i;
      answers.push_back(stage.edit_later(named("keyframe.add"), [time_s](Transaction& t) -> Answer {
        const model::KeyframeId id = t.new_keyframe_id();
        const model::VertexKeyPtr vertices = square_at(*t.scene().actors[0]->model->mesh, 0.0F);
        t.apply(SetKeyframe{"square", "default", id, TimedKeyframe{time_s, {id, {}, {}, vertices}}});
        return std::to_string(id);
      }));
    }
    for (auto& future : answers) {
      const Answer answer = RunningStage::wait(std::move(future));
      if (answer) kept.push_back(*answer);
    }
  }
  const model::Clip& clip = *stage.view()->scene->actors[0]->clips[0];
  ASSERT_EQ(clip.keyframes.size(), kept.size() + 1);
  for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(std::to_string(clip.keyframes[i + 1].id), kept[i]);
  EXPECT_EQ(stage.revision(), kept.size());
}

TEST(StageFailure, LetsARetryBeCarriedOutAgain) {
  RunningStage stage;
  stage.start();
  stage.store.fail_next(1);
  expect_unavailable(stage.edit(named("test.edit", "key"), RunningStage::applies(ambient(1.0F))));
  EXPECT_EQ(*stage.edit(named("test.edit", "key"), RunningStage::applies(ambient(1.0F))), "1");
  EXPECT_EQ(*stage.edit(named("test.edit", "key"), RunningStage::applies(ambient(1.0F))), "1");
  EXPECT_EQ(stage.revision(), 1U);
}

TEST(StageFailure, AnswersARetryThatWaitsAsTheFirst) {
  RunningStage stage;
  stage.start();
  stage.store.hold();
  auto first = stage.edit_later(named("test.edit", "key"), RunningStage::applies(ambient(1.0F)));
  auto retry = stage.edit_later(named("test.edit", "key"), RunningStage::applies(ambient(1.0F)));
  stage.settle();
  stage.store.fail_next(1);
  stage.store.release();
  expect_unavailable(RunningStage::wait(std::move(first)));
  expect_unavailable(RunningStage::wait(std::move(retry)));
  EXPECT_EQ(stage.revision(), 0U);
}

TEST(StageFailure, KeepsWhatCouldBeUndoneAndRedone) {
  RunningStage stage;
  stage.start();
  for (const float value : {1.0F, 2.0F}) ASSERT_TRUE(stage.edit(ambient(value)));
  ASSERT_TRUE(stage.undo());
  stage.store.fail_next(3);
  expect_unavailable(stage.undo());
  expect_unavailable(stage.redo());
  expect_unavailable(stage.edit(ambient(9.0F)));
  ASSERT_TRUE(stage.redo()) << "the lost edit did not forget it";
  EXPECT_EQ(ambient_of(stage), 2.0F);
  ASSERT_TRUE(stage.undo());
  ASSERT_TRUE(stage.undo());
  EXPECT_EQ(ambient_of(stage), 0.2F);
}

TEST(StageFailure, OfACreationLeavesNoScene) {
  RunningStage stage;
  stage.start();
  stage.store.fail_next(1);
  expect_unavailable(RunningStage::wait(stage.create_later({"new", "scene.create", {}, {}})));
  EXPECT_FALSE(stage.view("new"));
  EXPECT_FALSE(stage->head("new"));
  EXPECT_TRUE(RunningStage::wait(stage.create_later({"new", "scene.create", {}, {}})));
  EXPECT_TRUE(stage.view("new"));
}

TEST(StageFailure, OfARemovalLeavesTheScene) {
  RunningStage stage({scene_of("main"), scene_of("other", {square_actor("square")})});
  stage.start();
  const SceneViewPtr before = stage.view("other");
  stage.store.hold();
  auto removal = stage.remove_later({"other", "scene.remove", {}, {}});
  auto creation = stage.create_later({"other", "scene.create", {}, {}});
  stage.settle();
  stage.store.fail_next(1);
  stage.store.release();
  expect_unavailable(RunningStage::wait(std::move(removal)));
  expect_unavailable(RunningStage::wait(std::move(creation)));
  EXPECT_EQ(stage.view("other"), before);
  EXPECT_EQ(stage->head("other"), before->scene);
  EXPECT_TRUE(stage.edit({"other", "test.edit", {}, {}}, RunningStage::applies(ambient(1.0F))));
}

TEST(StageFailure, StopsNoPlayer) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  const ClockUs started_us = stage.act(&Player::play).now_us;
  stage.store.fail_next(1);
  expect_unavailable(stage.edit(SetActor{"square", nullptr}));
  const Player& player = stage.view()->players->at(0);
  EXPECT_TRUE(player.playing);
  EXPECT_EQ(player.anchor_us, started_us);
}

}  // namespace
}  // namespace tweend::stage
