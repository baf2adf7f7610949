#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "server/stage/stage.hpp"
#include "tests/support/running_stage.hpp"

namespace tweend::stage {
namespace {

using test::RunningStage;
using test::scene_of;
using test::square_actor;
using Kind = RunningStage::Kind;

EditOptions create(std::string scene) { return {std::move(scene), "scene.create", {}, {}}; }
EditOptions remove(std::string scene) { return {std::move(scene), "scene.remove", {}, {}}; }
const SetSceneSettings kGrid{test::with_grid(true)};

TEST(StageScenes, AreCreatedEmptyAtRevisionOne) {
  RunningStage stage;
  stage.start();
  EXPECT_EQ(*RunningStage::wait(stage.create_later(create("new"))), "created 1");
  ASSERT_TRUE(stage.view("new"));
  EXPECT_EQ(stage.revision("new"), 1U);
  EXPECT_EQ(stage.view("new")->scene->settings, model::SceneSettings{});
  EXPECT_EQ(stage.metrics.scenes.load(), 2);
  stage.wait_for(Kind::Edited, 1);
  EXPECT_EQ(stage.told().back().edit->method, "scene.create");
  EXPECT_EQ(stage.store.durable("new"), stage.view("new")->scene);
}

TEST(StageScenes, OfATakenNameAreAConflict) {
  RunningStage stage;
  stage.start();
  stage.store.hold();
  auto first = stage.create_later(create("new"));
  auto second = stage.create_later(create("new"));
  stage.settle();
  stage.store.release();
  EXPECT_TRUE(RunningStage::wait(std::move(first)));
  const auto answer = RunningStage::wait(std::move(second));
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::Conflict);
  EXPECT_EQ(RunningStage::wait(stage.create_later(create("main"))).error().code, ErrorCode::Conflict);
}

TEST(StageScenes, AreLimited) {
  RunningStage stage({}, {.scenes = 3});
  stage.start();
  EXPECT_TRUE(RunningStage::wait(stage.create_later(create("a"))));
  EXPECT_TRUE(RunningStage::wait(stage.create_later(create("b"))));
  const auto answer = RunningStage::wait(stage.create_later(create("c")));
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::Limit);
  EXPECT_TRUE(RunningStage::wait(stage.remove_later(remove("a"))));
  EXPECT_TRUE(RunningStage::wait(stage.create_later(create("c"))));
}

TEST(StageScenes, MakeRoomAsSoonAsTheRemovalIsPlanned) {
  RunningStage stage({}, {.scenes = 2});
  stage.start();
  ASSERT_TRUE(RunningStage::wait(stage.create_later(create("a"))));
  stage.store.hold();
  auto removal = stage.remove_later(remove("a"));
  auto creation = stage.create_later(create("b"));
  stage.settle();
  stage.store.release();
  EXPECT_TRUE(RunningStage::wait(std::move(removal)));
  EXPECT_TRUE(RunningStage::wait(std::move(creation))) << "requests of a connection are carried out in their order";
}

TEST(StageScenes, AreRemovedOnlyWhenThatIsDurable) {
  RunningStage stage({scene_of("main"), scene_of("old", {square_actor("square")})});
  stage.start();
  stage.store.hold();
  auto removal = stage.remove_later(remove("old"));
  stage.store.wait_for_commits(1);
  stage.settle();
  EXPECT_TRUE(stage.view("old"));
  EXPECT_FALSE(stage->head("old"));
  EXPECT_EQ(stage.edit({"old", "test.edit", {}, {}}, RunningStage::applies(kGrid)).error().code, ErrorCode::NotFound);
  EXPECT_TRUE(stage.act(&Player::play, {}, "old").view) << "it is played until it is gone";
  stage.store.release();
  EXPECT_EQ(*RunningStage::wait(std::move(removal)), "removed 1");
  EXPECT_FALSE(stage.view("old"));
  EXPECT_EQ(stage.metrics.scenes.load(), 1);
  EXPECT_EQ(stage.metrics.actors.load(), 0);
  EXPECT_FALSE(stage.change_players("old", RunningStage::every_player(&Player::play)));
  bool told = false;
  for (const auto& t : stage.told()) told = told || (t.kind == Kind::Published && t.scene == "old" && !t.view);
  EXPECT_TRUE(told);
}

TEST(StageScenes, AreRemovedAfterTheEditsThatWaitBeforeThem) {
  RunningStage stage({scene_of("main"), scene_of("old")});
  stage.start();
  stage.store.hold();
  auto first = stage.edit_later({"main", "test.edit", {}, {}}, RunningStage::applies(kGrid));
  stage.store.wait_for_commits(1);
  auto edit = stage.edit_later({"old", "test.edit", {}, {}}, RunningStage::applies(kGrid));
  auto removal = stage.remove_later(remove("old"));
  auto late = stage.edit_later({"old", "test.edit", {}, {}}, RunningStage::applies(kGrid));
  stage.settle();
  stage.store.release();
  EXPECT_EQ(*RunningStage::wait(std::move(edit)), "1");
  EXPECT_EQ(*RunningStage::wait(std::move(removal)), "removed 2");
  EXPECT_EQ(RunningStage::wait(std::move(late)).error().code, ErrorCode::NotFound);
  EXPECT_FALSE(stage.view("old"));
  EXPECT_FALSE(stage.store.durable("old"));
}

TEST(StageScenes, CreatedAgainWhileTheRemovalWaitsStartAnew) {
  RunningStage stage({scene_of("main"), scene_of("again", {square_actor("square")})});
  stage.start();
  stage.store.hold();
  auto removal = stage.remove_later(remove("again"));
  stage.store.wait_for_commits(1);  // alone in its commit
  auto creation = stage.create_later(create("again"));
  auto edit = stage.edit_later({"again", "test.edit", {}, {}}, RunningStage::applies(kGrid));
  stage.settle();
  stage.store.release();
  EXPECT_TRUE(RunningStage::wait(std::move(removal)));
  EXPECT_EQ(*RunningStage::wait(std::move(creation)), "created 1");
  EXPECT_EQ(*RunningStage::wait(std::move(edit)), "2");
  ASSERT_TRUE(stage.view("again"));
  EXPECT_TRUE(stage.view("again")->scene->actors.empty());
  EXPECT_TRUE(stage.view("again")->scene->settings.grid);
  ASSERT_TRUE(stage.undo("again"));
  EXPECT_FALSE(stage.undo("again")) << "the history of the old scene is gone with it";
}

TEST(StageScenes, RemovedAndCreatedInOneCommitStartAnew) {
  RunningStage stage({scene_of("main"), scene_of("again", {square_actor("square")})});
  stage.start();
  stage.store.hold();
  auto first = stage.edit_later({"main", "test.edit", {}, {}}, RunningStage::applies(kGrid));
  stage.store.wait_for_commits(1);
  auto removal = stage.remove_later(remove("again"));
  auto creation = stage.create_later(create("again"));
  stage.settle();
  stage.store.release();
  EXPECT_TRUE(RunningStage::wait(std::move(removal)));
  EXPECT_TRUE(RunningStage::wait(std::move(creation)));
  ASSERT_TRUE(stage.view("again"));
  EXPECT_EQ(stage.revision("again"), 1U);
  EXPECT_TRUE(stage.view("again")->players->empty());
  EXPECT_TRUE(RunningStage::wait(stage.remove_later(remove("again"))));
  EXPECT_FALSE(stage.view("again"));
}

TEST(StageScenes, HaveHistoriesOfTheirOwn) {
  RunningStage stage({scene_of("main"), scene_of("other")});
  stage.start();
  ASSERT_TRUE(stage.edit({"other", "test.edit", {}, {}}, RunningStage::applies(kGrid)));
  EXPECT_FALSE(stage.undo("main"));
  EXPECT_TRUE(stage.undo("other"));
  EXPECT_FALSE(stage.view("other")->scene->settings.grid);
}

}  // namespace
}  // namespace tweend::stage
