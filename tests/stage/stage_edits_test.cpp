#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/stage/stage.hpp"
#include "tests/support/running_stage.hpp"

namespace tweend::stage {
namespace {

using test::RunningStage;
using test::scene_of;
using test::square_actor;
using test::square_at;
using Kind = RunningStage::Kind;

constexpr auto kNow = std::chrono::seconds(0);

bool answered(const std::future<RunningStage::Answer>& answer) { return answer.wait_for(kNow) == std::future_status::ready; }

EditOptions named(const std::string& method, std::string retry_key = {}) { return {"main", method, {}, std::move(retry_key)}; }

SetSceneSettings ambient(float value) { return SetSceneSettings{test::with_ambient(value)}; }
float ambient_of(const RunningStage& stage) { return stage.view()->scene->settings.light.ambient; }

TEST(StageEdit, AnswersWithTheResultOfItsPlan) {
  RunningStage stage;
  stage.start();
  const auto answer = stage.edit(named("test.edit"), [](Transaction& t) -> Result<std::string> {
    t.apply(ambient(0.75F));
    return "{\"revision\":" + std::to_string(t.revision()) + "}";
  });
  EXPECT_EQ(*answer, "{\"revision\":1}");
  EXPECT_EQ(stage.revision(), 1U);
  EXPECT_EQ(ambient_of(stage), 0.75F);
  EXPECT_EQ(stage.metrics.edits_total.load(), 1);
  EXPECT_EQ(stage.metrics.commits_total.load(), 1);
}

TEST(StageEdit, IsAnsweredAndPublishedOnlyWhenItIsDurable) {
  RunningStage stage;
  stage.start();
  const SceneViewPtr before = stage.view();
  stage.store.hold();
  auto answer = stage.edit_later(named("test.edit"), RunningStage::applies(ambient(0.5F)));
  stage.store.wait_for_commits(1);
  stage.settle();
  EXPECT_FALSE(answered(answer));
  EXPECT_EQ(stage.view(), before);
  EXPECT_EQ(stage->head("main")->revision, 1U) << "the next edit is planned on it already";
  EXPECT_EQ(stage.count(Kind::Edited), 0U);
  stage.store.release();
  EXPECT_EQ(*RunningStage::wait(std::move(answer)), "1");
  EXPECT_EQ(ambient_of(stage), 0.5F);
}

TEST(StageEdit, IsPublishedAndToldBeforeItIsAnswered) {
  RunningStage stage;
  stage.start();
  std::promise<std::pair<std::uint64_t, std::size_t>> at_answer;
  stage->edit(named("test.edit"), RunningStage::applies(ambient(0.5F)), [&](const Result<std::string>&) {
    at_answer.set_value({stage.revision(), stage.count(Kind::Edited)});
  });
  const auto [revision, told] = at_answer.get_future().get();
  EXPECT_EQ(revision, 1U);
  EXPECT_EQ(told, 1U) << "whoever subscribes after the answer hears nothing of it";
  stage.wait_for(Kind::Edited, 1);
}

TEST(StageEdit, TellsWhatItWasAbout) {
  RunningStage stage;
  stage.start();
  ASSERT_TRUE(stage.edit(named("keyframe.add"), [](Transaction& t) -> Result<std::string> {
    t.about({"square", "default", 9});
    return std::string();
  }));
  stage.wait_for(Kind::Edited, 1);
  const EditEvent event = *stage.told().back().edit;
  EXPECT_EQ(event.scene, "main");
  EXPECT_EQ(event.method, "keyframe.add");
  EXPECT_EQ(event.revision, 1U);
  EXPECT_EQ(event.subject.actor, "square");
  EXPECT_EQ(event.subject.clip, "default");
  EXPECT_EQ(event.subject.keyframe, 9);
}

TEST(StageEdit, HandsTheStoreAllThatMustSurvive) {
  RunningStage stage;
  stage.start();
  ASSERT_TRUE(stage.edit(named("scene.update", "key"), RunningStage::applies(ambient(0.5F))));
  const auto groups = stage.store.groups();
  ASSERT_EQ(groups.size(), 1U);
  ASSERT_EQ(groups[0].size(), 1U);
  EXPECT_EQ(groups[0][0].scene, "main");
  EXPECT_EQ(groups[0][0].method, "scene.update");
  EXPECT_EQ(groups[0][0].retry_key, "key");
  EXPECT_EQ(groups[0][0].answer, "1");
  EXPECT_EQ(groups[0][0].after, stage.view()->scene);
}

TEST(StageEdit, AllThatWaitAreOneCommit) {
  RunningStage stage;
  stage.start();
  stage.store.hold();
  std::vector<std::future<RunningStage::Answer>> answers;
  answers.push_back(stage.edit_later(named("test.edit"), RunningStage::applies(ambient(0.0F))));
  stage.store.wait_for_commits(1);
  for (int i = 1; i <= 20; ++i) {
    answers.push_back(stage.edit_later(named("test.edit"), RunningStage::applies(ambient(static_cast<float>(i)))));
  }
  stage.settle();
  stage.store.release();
  for (std::size_t i = 0; i < answers.size(); ++i) EXPECT_EQ(*RunningStage::wait(std::move(answers[i])), std::to_string(i + 1));
  const auto groups = stage.store.groups();
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[1].size(), 20U);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(groups[1][i].after->revision, i + 2) << "in the order of the edits";
  EXPECT_EQ(ambient_of(stage), 20.0F);
  EXPECT_EQ(stage.metrics.edits_total.load(), 21);
  EXPECT_EQ(stage.metrics.commits_total.load(), 2);
  stage.wait_for(Kind::Edited, 21);
}

TEST(StageEdit, ARefusedOneChangesNothingAndReachesNoStore) {
  RunningStage stage;
  stage.start();
  const SceneViewPtr before = stage.view();
  const auto answer = stage.edit(named("test.edit", "key"), [](Transaction& t) -> Result<std::string> {
    t.apply(ambient(0.9F));
    return fail(ErrorCode::InvalidParams, "expected something else", "params.time");
  });
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::InvalidParams);
  EXPECT_EQ(answer.error().path, "params.time");
  EXPECT_EQ(stage.view(), before);
  EXPECT_EQ(stage->head("main")->revision, 0U);
  EXPECT_TRUE(stage.store.groups().empty());
  EXPECT_TRUE(stage.edit(named("test.edit", "key"), RunningStage::applies(ambient(0.1F)))) << "its key was not used";
}

TEST(StageEdit, OfASceneThatIsNotThereIsNotFound) {
  RunningStage stage;
  stage.start();
  const auto answer = stage.edit({"nowhere", "test.edit", {}, {}}, RunningStage::applies(ambient(0.1F)));
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::NotFound);
  EXPECT_EQ(answer.error().path, "params.scene");
}

TEST(StageBaseRevision, OfTheSceneAsItStandsIsTaken) {
  RunningStage stage;
  stage.start();
  EXPECT_TRUE(stage.edit({"main", "test.edit", 0, {}}, RunningStage::applies(ambient(0.1F))));
  EXPECT_TRUE(stage.edit({"main", "test.edit", 1, {}}, RunningStage::applies(ambient(0.2F))));
}

TEST(StageBaseRevision, ThatTheSceneHasGonePastIsAConflictThatNamesTheRevision) {
  RunningStage stage;
  stage.start();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(stage.edit(ambient(0.1F)));
  const auto expect_conflict = [](const RunningStage::Answer& answer) {
    ASSERT_FALSE(answer);
    EXPECT_EQ(answer.error().code, ErrorCode::Conflict);
    EXPECT_EQ(answer.error().revision, 3U);
  };
  expect_conflict(stage.edit({"main", "test.edit", 2, {}}, RunningStage::applies(ambient(0.2F))));
  expect_conflict(RunningStage::wait(stage.move_later({"main", "edit.undo", 1, {}}, HistoryMove::Undo)));
  expect_conflict(RunningStage::wait(stage.remove_later({"main", "scene.remove", 1, {}})));
  EXPECT_EQ(stage.revision(), 3U);
  EXPECT_EQ(ambient_of(stage), 0.1F);
}

TEST(StageRetryKey, IsAnsweredAsTheFirstTimeWithoutAnotherEdit) {
  RunningStage stage;
  stage.start();
  EXPECT_EQ(*stage.edit(named("test.edit", "key"), RunningStage::applies(ambient(0.1F))), "1");
  ASSERT_TRUE(stage.edit(ambient(0.5F)));
  EXPECT_EQ(*stage.edit(named("test.edit", "key"), RunningStage::applies(ambient(0.1F))), "1");
  EXPECT_EQ(*stage.edit({"main", "test.edit", 0, "key"}, RunningStage::applies(ambient(0.1F))), "1") << "also on an old base";
  EXPECT_EQ(stage.revision(), 2U);
  EXPECT_EQ(ambient_of(stage), 0.5F);
  EXPECT_EQ(*stage.edit(named("test.edit", "other"), RunningStage::applies(ambient(0.1F))), "3");
}

TEST(StageRetryKey, WaitsForTheFirstWhileThatIsOnItsWayToTheDisk) {
  RunningStage stage;
  stage.start();
  stage.store.hold();
  std::vector<std::future<RunningStage::Answer>> answers;
  for (int i = 0; i < 3; ++i) {
    answers.push_back(stage.edit_later(named("test.edit", "key"), RunningStage::applies(ambient(0.1F))));
  }
  stage.store.wait_for_commits(1);
  stage.settle();
  for (const auto& answer : answers) EXPECT_FALSE(answered(answer));
  stage.store.release();
  for (auto& answer : answers) EXPECT_EQ(*RunningStage::wait(std::move(answer)), "1");
  EXPECT_EQ(stage.revision(), 1U);
}

TEST(StageRetryKey, BelongsToItsScene) {
  RunningStage stage({scene_of("main"), scene_of("other")});
  stage.start();
  EXPECT_EQ(*stage.edit(named("test.edit", "key"), RunningStage::applies(ambient(0.1F))), "1");
  EXPECT_EQ(*stage.edit({"other", "test.edit", {}, "key"}, RunningStage::applies(ambient(0.1F))), "1");
  EXPECT_EQ(stage.revision("other"), 1U);
}

TEST(StageRetryKey, GuardsUndoAndScenesToo) {
  RunningStage stage;
  stage.start();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(stage.edit(ambient(0.1F)));
  const auto undo = [&] { return *RunningStage::wait(stage.move_later(named("edit.undo", "undo"), HistoryMove::Undo)); };
  EXPECT_EQ(undo(), "test.edit 4");
  EXPECT_EQ(undo(), "test.edit 4");
  EXPECT_EQ(stage.revision(), 4U);
  const auto create = [&] { return *RunningStage::wait(stage.create_later({"new", "scene.create", {}, "create"})); };
  EXPECT_EQ(create(), create());
  const auto remove = [&] { return *RunningStage::wait(stage.remove_later({"new", "scene.remove", {}, "remove"})); };
  EXPECT_EQ(remove(), remove());
}

TEST(StageUndo, TakesBackOneEditAtATimeAsANewRevision) {
  RunningStage stage;
  stage.start();
  for (const float value : {1.0F, 2.0F, 3.0F}) ASSERT_TRUE(stage.edit(ambient(value)));
  EXPECT_EQ(*stage.undo(), "test.edit 4");
  EXPECT_EQ(ambient_of(stage), 2.0F);
  EXPECT_EQ(*stage.undo(), "test.edit 5");
  EXPECT_EQ(ambient_of(stage), 1.0F);
  EXPECT_EQ(*stage.redo(), "test.edit 6");
  EXPECT_EQ(ambient_of(stage), 2.0F);
  EXPECT_EQ(*stage.redo(), "test.edit 7");
  EXPECT_EQ(ambient_of(stage), 3.0F);
  EXPECT_EQ(*stage.undo(), "test.edit 8");
  EXPECT_EQ(ambient_of(stage), 2.0F);
  EXPECT_EQ(stage.revision(), 8U);
}

TEST(StageUndo, WithNothingLeftIsNotFound) {
  RunningStage stage;
  stage.start();
  const auto expect_not_found = [](const RunningStage::Answer& answer) {
    ASSERT_FALSE(answer);
    EXPECT_EQ(answer.error().code, ErrorCode::NotFound);
  };
  expect_not_found(stage.undo());
  expect_not_found(stage.redo());
  ASSERT_TRUE(stage.edit(ambient(1.0F)));
  expect_not_found(stage.redo());
  ASSERT_TRUE(stage.undo());
  expect_not_found(stage.undo());
  EXPECT_EQ(stage.revision(), 2U);
}

TEST(StageUndo, TakesBackAllChangesOfAnEdit) {
  RunningStage stage({scene_of("main", {square_actor("a"), square_actor("b")})});
  stage.start();
  const auto actors = stage.view()->scene->actors;
  ASSERT_TRUE(stage.edit(named("edit.apply"), [](Transaction& t) -> Result<std::string> {
    t.apply(SetKeyframe{"a", "default", 1, {}});
    t.apply(SetActor{"a", nullptr});
    t.apply(SetActorSettings{"b", test::with_visible(false)});
    return std::string();
  }));
  EXPECT_EQ(stage.view()->scene->actors.size(), 1U);
  EXPECT_EQ(*stage.undo(), "edit.apply 2");
  ASSERT_EQ(stage.view()->scene->actors.size(), 2U);
  EXPECT_EQ(stage.view()->scene->actors[0]->clips[0]->keyframes, actors[0]->clips[0]->keyframes);
  EXPECT_TRUE(stage.view()->scene->actors[1]->settings.visible);
}

TEST(StageUndo, ANewEditForgetsWhatCouldBeRedone) {
  RunningStage stage;
  stage.start();
  for (const float value : {1.0F, 2.0F}) ASSERT_TRUE(stage.edit(ambient(value)));
  ASSERT_TRUE(stage.undo());
  ASSERT_TRUE(stage.edit(ambient(5.0F)));
  EXPECT_FALSE(stage.redo());
  ASSERT_TRUE(stage.undo());
  EXPECT_EQ(ambient_of(stage), 1.0F);
}

TEST(StageUndo, ReachesAsFarAsTheLimit) {
  RunningStage stage({}, {.undo_steps = 5});
  stage.start();
  for (int i = 1; i <= 20; ++i) ASSERT_TRUE(stage.edit(ambient(static_cast<float>(i))));
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(stage.undo());
  EXPECT_FALSE(stage.undo());
  EXPECT_EQ(ambient_of(stage), 15.0F);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(stage.redo());
  EXPECT_FALSE(stage.redo());
  EXPECT_EQ(ambient_of(stage), 20.0F);
}

TEST(StageUndo, NeverLetsAKeyframesIdBeUsedAgain) {
  RunningStage stage({scene_of("main", {square_actor("square")})});
  stage.start();
  std::set<model::KeyframeId> given{1, 2, 3};
  const auto add_keyframe = [&](double time_s) {
    const auto answer = stage.edit(named("keyframe.add"), [time_s](Transaction& t) -> Result<std::string> {
      const model::KeyframeId id = t.new_keyframe_id();
      const model::VertexKeyPtr vertices = square_at(*t.scene().actors[0]->model->mesh, 0.0F);
      t.apply(SetKeyframe{"square", "default", id, TimedKeyframe{time_s, {id, {}, {}, vertices}}});
      return std::to_string(id);
    });
    EXPECT_TRUE(given.insert(std::stoll(*answer)).second) << "the id " << *answer << " was used before";
  };
  for (int i = 0; i < 5; ++i) {
    add_keyframe(10.0);
    ASSERT_TRUE(stage.undo());
  }
  add_keyframe(20.0);
  ASSERT_TRUE(stage.undo());
  ASSERT_TRUE(stage.redo());
  EXPECT_TRUE(stage.view()->scene->actors[0]->clips[0]->index_of(*given.rbegin())) << "redone, it is the same keyframe";
  add_keyframe(30.0);
}

TEST(StageUndo, ChainsWhileTheEditsStillWaitForTheDisk) {
  RunningStage stage;
  stage.start();
  stage.store.hold();
  std::vector<std::future<RunningStage::Answer>> answers;
  answers.push_back(stage.edit_later(named("test.edit"), RunningStage::applies(ambient(1.0F))));
  answers.push_back(stage.edit_later(named("test.edit"), RunningStage::applies(ambient(2.0F))));
  answers.push_back(stage.move_later(named("edit.undo"), HistoryMove::Undo));
  answers.push_back(stage.move_later(named("edit.undo"), HistoryMove::Undo));
  answers.push_back(stage.move_later(named("edit.redo"), HistoryMove::Redo));
  stage.settle();
  stage.store.release();
  for (auto& answer : answers) EXPECT_TRUE(RunningStage::wait(std::move(answer)));
  EXPECT_EQ(ambient_of(stage), 1.0F);
  EXPECT_EQ(stage.revision(), 5U);
}

}  // namespace
}  // namespace tweend::stage
