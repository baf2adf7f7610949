#include "server/stage/change.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/scenes.hpp"

namespace tweend::stage {
namespace {

using model::Actor;
using model::ActorPtr;
using model::Clip;
using model::ClipPtr;
using model::Scene;
using test::ClipParts;
using test::rising_clip;
using test::scene_of;
using test::square_actor;
using test::square_at;

/// Equal in all that is small; meshes and vertices are the very same.
void expect_same(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.settings, b.settings);
  ASSERT_EQ(a.actors.size(), b.actors.size());
  for (std::size_t i = 0; i < a.actors.size(); ++i) {
    const Actor& left = *a.actors[i];
    const Actor& right = *b.actors[i];
    EXPECT_EQ(left.name, right.name);
    EXPECT_EQ(left.model, right.model);
    EXPECT_EQ(left.settings, right.settings);
    ASSERT_EQ(left.clips.size(), right.clips.size());
    for (std::size_t c = 0; c < left.clips.size(); ++c) {
      EXPECT_EQ(left.clips[c]->name, right.clips[c]->name);
      EXPECT_EQ(left.clips[c]->settings, right.clips[c]->settings);
      EXPECT_EQ(left.clips[c]->times_s, right.clips[c]->times_s);
      EXPECT_EQ(left.clips[c]->keyframes, right.clips[c]->keyframes);  // pointers to vertices
    }
  }
}

/// Changes of every kind to whatever a scene has, and to what it has not.
class RandomChanges {
 public:
  explicit RandomChanges(std::uint32_t seed) : random_(seed) {}

  Change next(const Scene& scene) {
    if (scene.actors.empty()) return add_actor();
    const ActorPtr actor = scene.actors[below(scene.actors.size())];
    const ClipPtr clip = actor->clips[below(actor->clips.size())];
    switch (below(11)) {
      case 0:
        return add_actor();
      case 1:
        return SetActor{actor->name, nullptr};
      case 2:
        return SetActor{actor->name, square_actor(actor->name)};  // another model in its place
      case 3:
        return SetActorSettings{actor->name, test::with_spin(static_cast<double>(below(9)))};
      case 4: {
        const std::string name = "clip " + std::to_string(below(5));
        return SetClip{actor->name, name, rising(*actor, name), below(4)};
      }
      case 5:
        if (actor->clips.size() < 2) return SetSceneSettings{test::with_grid(below(2) == 0)};
        return SetClip{actor->name, clip->name, nullptr};
      case 6:
        return SetClipSettings{actor->name, clip->name, test::with_closed(below(2) == 0, 1000.0)};
      case 7:
        return SetSceneSettings{test::with_ambient(static_cast<float>(below(5)))};
      case 8:
        if (clip->keyframes.empty()) return add_keyframe(*actor, *clip);
        return SetKeyframe{actor->name, clip->name, clip->keyframes[below(clip->keyframes.size())].id, {}};
      case 9: {
        if (clip->keyframes.empty()) return add_keyframe(*actor, *clip);
        model::Keyframe moved = clip->keyframes[below(clip->keyframes.size())];
        moved.easing = animation::CubicBezier{0.1, 0.2, 0.3, 0.4};
        return SetKeyframe{actor->name, clip->name, moved.id, TimedKeyframe{free_time(), moved}};
      }
      default:
        return add_keyframe(*actor, *clip);
    }
  }

 private:
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
  double free_time() { return std::uniform_real_distribution(0.0, 900.0)(random_); }
  ClipPtr rising(const Actor& actor, const std::string& name) {
    last_id_ += 3;
    return rising_clip(*actor.model->mesh, {.name = name, .first_id = last_id_ - 2});
  }
  Change add_actor() {
    std::string name = "actor " + std::to_string(++last_actor_);
    ActorPtr actor = square_actor(name);
    return SetActor{std::move(name), std::move(actor), below(2) == 0 ? SIZE_MAX : below(3)};
  }
  Change add_keyframe(const Actor& actor, const Clip& clip) {
    const model::KeyframeId id = ++last_id_;
    return SetKeyframe{actor.name, clip.name, id,
                       TimedKeyframe{free_time(), {id, {}, {}, square_at(*actor.model->mesh, 7.0F)}}};
  }

  std::mt19937 random_;
  model::KeyframeId last_id_ = 1000;
  int last_actor_ = 0;
};

TEST(Change, AppliedBackwardsTheInversesRestoreTheScene) {
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    RandomChanges changes(seed);
    const Scene first = *scene_of("main", {square_actor("square")});
    Scene scene = first;
    std::vector<Scene> states;
    std::vector<Change> inverses;
    for (int i = 0; i < 100; ++i) {
      states.push_back(scene);
      inverses.push_back(stage::apply(scene, changes.next(scene)));
    }
    for (std::size_t i = inverses.size(); i-- > 0;) {
      static_cast<void>(stage::apply(scene, inverses[i]));
      expect_same(scene, states[i]);
      if (::testing::Test::HasFailure()) return;
    }
  }
}

TEST(Change, TheInverseOfAnInverseDoesItAgain) {
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    RandomChanges changes(seed);
    Scene scene = *scene_of("main", {square_actor("square")});
    for (int i = 0; i < 60; ++i) {
      const Scene before = scene;
      const Change inverse = stage::apply(scene, changes.next(scene));
      const Scene after = scene;
      const Change again = stage::apply(scene, inverse);
      expect_same(scene, before);
      static_cast<void>(stage::apply(scene, again));
      expect_same(scene, after);
      if (::testing::Test::HasFailure()) return;
    }
  }
}

TEST(Change, NeverTouchesTheSceneItWasCopiedFrom) {
  const Scene first = *scene_of("main", {square_actor("square")});
  const ActorPtr actor = first.actors[0];
  const ClipPtr clip = actor->clips[0];
  const std::vector<double> times_s = clip->times_s;
  Scene copy = first;
  static_cast<void>(stage::apply(copy, SetKeyframe{"square", "default", 1, {}}));
  static_cast<void>(stage::apply(copy, SetClipSettings{"square", "default", test::with_closed(true)}));
  static_cast<void>(stage::apply(copy, SetActorSettings{"square", test::with_visible(false)}));
  EXPECT_EQ(first.actors[0], actor);
  EXPECT_EQ(actor->clips[0], clip);
  EXPECT_EQ(clip->times_s, times_s);
  EXPECT_FALSE(clip->settings.closed);
  EXPECT_TRUE(actor->settings.visible);
}

TEST(Change, DoesNotTouchTheRevision) {
  Scene scene = *scene_of("main");
  scene.revision = 41;
  static_cast<void>(stage::apply(scene, SetSceneSettings{test::with_grid(true)}));
  EXPECT_EQ(scene.revision, 41U);
}

TEST(Change, AnAddedKeyframeSharesTheVerticesOfAHundredOthers) {
  const ActorPtr actor = square_actor("square", {{.keys = 100}});
  Scene scene = *scene_of("main", {actor, square_actor("other")});
  const ActorPtr other = scene.actors[1];
  const model::VertexKeyPtr added = square_at(*actor->model->mesh, 50.5F);
  static_cast<void>(stage::apply(scene, SetKeyframe{"square", "default", 101, TimedKeyframe{50.5, {101, {}, {}, added}}}));
  const Clip& before = *actor->clips[0];
  const Clip& after = *scene.actors[0]->clips[0];
  ASSERT_EQ(after.keyframes.size(), 101U);
  EXPECT_EQ(after.keyframes[51].vertices, added);
  EXPECT_EQ(after.times_s[51], 50.5);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(after.keyframes[i < 51 ? i : i + 1].vertices, before.keyframes[i].vertices);
  }
  EXPECT_EQ(scene.actors[0]->model, actor->model);
  EXPECT_EQ(scene.actors[1], other) << "an actor that was not touched is the very same";
}

TEST(Change, KeyframesStandInTheOrderOfTheirTimes) {
  Scene scene = *scene_of("main", {square_actor("square", {{.keys = 4}})});
  const auto clip = [&]() -> const Clip& { return *scene.actors[0]->clips[0]; };
  model::Keyframe moved = clip().keyframes[0];
  static_cast<void>(stage::apply(scene, SetKeyframe{"square", "default", moved.id, TimedKeyframe{2.5, moved}}));
  EXPECT_EQ(clip().times_s, (std::vector<double>{1.0, 2.0, 2.5, 3.0}));
  EXPECT_EQ(clip().keyframes[2].id, moved.id);
}

TEST(Change, ARemovedActorComesBackToItsPlace) {
  Scene scene = *scene_of("main", {square_actor("a"), square_actor("b"), square_actor("c")});
  const ActorPtr b = scene.actors[1];
  const Change inverse = stage::apply(scene, SetActor{"b", nullptr});
  ASSERT_EQ(scene.actors.size(), 2U);
  static_cast<void>(stage::apply(scene, inverse));
  ASSERT_EQ(scene.actors.size(), 3U);
  EXPECT_EQ(scene.actors[1], b);
}

}  // namespace
}  // namespace tweend::stage
