#include "server/stage/transaction.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/support/scenes.hpp"

namespace tweend::stage {
namespace {

using test::scene_of;
using test::square_actor;

TEST(Transaction, HasTheNextRevision) {
  model::Scene head = *scene_of("main");
  head.revision = 7;
  const Transaction transaction(head);
  EXPECT_EQ(transaction.revision(), 8U);
  EXPECT_EQ(transaction.scene().revision, 8U);
}

TEST(Transaction, DroppedHasChangedNothing) {
  const model::ScenePtr head = scene_of("main", {square_actor("square")});
  const model::Scene before = *head;
  {
    Transaction transaction(*head);
    transaction.apply(SetActor{"square", nullptr});
    transaction.apply(SetSceneSettings{test::with_grid(true)});
    static_cast<void>(transaction.new_keyframe_id());
  }
  EXPECT_EQ(head->revision, before.revision);
  EXPECT_EQ(head->next_keyframe, before.next_keyframe);
  EXPECT_EQ(head->settings, before.settings);
  EXPECT_EQ(head->actors, before.actors);
}

TEST(Transaction, TakesBackSeveralChangesInTheRightOrder) {
  const model::ScenePtr head = scene_of("main", {square_actor("a"), square_actor("b")});
  Transaction transaction(*head);
  transaction.apply(SetActorSettings{"a", test::with_visible(false)});
  transaction.apply(SetActorSettings{"a", test::with_spin(2.0)});
  transaction.apply(SetActor{"a", nullptr});
  transaction.apply(SetActor{"b", nullptr});
  EXPECT_TRUE(transaction.scene().actors.empty());
  Transaction back(transaction.scene());
  for (const Change& change : transaction.undo_changes()) back.apply(change);
  ASSERT_EQ(back.scene().actors.size(), 2U);
  EXPECT_EQ(back.scene().actors[0]->settings, model::ActorSettings{});
  EXPECT_EQ(back.scene().actors[0]->clips, head->actors[0]->clips);
  EXPECT_EQ(back.scene().actors[1], head->actors[1]);
}

TEST(Transaction, GivesEachKeyframeAnIdOfItsOwn) {
  model::Scene head = *scene_of("main");
  head.next_keyframe = 12;
  Transaction transaction(head);
  EXPECT_EQ(transaction.new_keyframe_id(), 12);
  EXPECT_EQ(transaction.new_keyframe_id(), 13);
  EXPECT_EQ(transaction.scene().next_keyframe, 14);
}

TEST(Transaction, KnowsWhatItIsAbout) {
  Transaction transaction(*scene_of("main"));
  EXPECT_FALSE(transaction.subject().actor);
  transaction.about({"square", "default", 4});
  EXPECT_EQ(transaction.subject().actor, "square");
  EXPECT_EQ(transaction.subject().clip, "default");
  EXPECT_EQ(transaction.subject().keyframe, 4);
}

}  // namespace
}  // namespace tweend::stage
