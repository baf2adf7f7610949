#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <utility>

#include "server/stage/show.hpp"
#include "tests/stage/players.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/scenes.hpp"

namespace tweend::stage {
namespace {

using test::square_actor;

model::ActorPtr three_clips() {
  return square_actor("square", {{.name = "a"}, {.name = "b", .first_id = 10}, {.name = "c", .first_id = 20}});
}

Player playing_a(const model::ActorPtr& actor) {
  Player player;
  player.actor = actor->name;
  player.clip = "a";
  player.play({0.0, 2.0}, 0);
  return player;
}

/// As playback.play {clip, fade} does.
void fade_to(Player& player, const model::ActorPtr& actor, const char* clip, double length_s, ClockUs now_us) {
  const Player before = player;
  player.rebase(player.range_of(*clip_of(*actor, player)), now_us);
  player.change_clip(*actor->find_clip(clip), now_us);
  player.fade_from(before, length_s, now_us);
}

TEST(PlayerFade, GoesFromTheOneToTheOtherLinearly) {
  const model::ActorPtr actor = three_clips();
  Player player = playing_a(actor);
  const std::uint64_t continuity = show_actor(actor, player, kSecond).continuity;
  fade_to(player, actor, "b", 0.4, kSecond);
  const ActorShow show = show_actor(actor, player, kSecond + 100'000);
  ASSERT_EQ(show.shown.clips.size(), 2U);
  EXPECT_EQ(show.shown.clips[0].clip->name, "a");
  EXPECT_NEAR(show.shown.clips[0].time_s, 1.1, 1e-9) << "it plays on by its own law";
  EXPECT_EQ(show.shown.clips[1].clip->name, "b");
  EXPECT_NEAR(show.shown.clips[1].time_s, 0.1, 1e-9);
  EXPECT_NEAR(show.shown.clips[1].weight, 0.25F, 1e-6F);
  EXPECT_EQ(show.clip->name, "b");
  EXPECT_EQ(show.continuity, continuity) << "a fade is no jump";
  const ActorShow after = show_actor(actor, player, kSecond + 400'000);
  EXPECT_EQ(after.shown.clips.size(), 1U);
  EXPECT_EQ(after.continuity, continuity);
}

TEST(PlayerFade, GoesOnWhileThePlayerIsPausedAndMovesUntilItIsOver) {
  const model::ActorPtr actor = three_clips();
  Player player = playing_a(actor);
  fade_to(player, actor, "b", 1.0, 0);
  player.pause({0.0, 2.0}, 250'000);
  const ActorShow show = show_actor(actor, player, 500'000);
  EXPECT_TRUE(show.moving);
  EXPECT_NEAR(show.shown.clips.back().weight, 0.5F, 1e-6F);
  EXPECT_NEAR(show.shown.clips.back().time_s, 0.25, 1e-9);
  EXPECT_TRUE(show_actor(actor, player, 999'999).moving);
  EXPECT_FALSE(show_actor(actor, player, 1'000'000).moving);
}

TEST(PlayerFade, NestsAndIsHiddenByWhatHasReplacedIt) {
  const model::ActorPtr actor = three_clips();
  Player player = playing_a(actor);
  fade_to(player, actor, "b", 1.0, 0);
  fade_to(player, actor, "c", 0.25, 500'000);
  const ActorShow nested = show_actor(actor, player, 600'000);
  ASSERT_EQ(nested.shown.clips.size(), 3U);
  EXPECT_NEAR(nested.shown.clips[1].weight, 0.6F, 1e-6F);
  EXPECT_NEAR(nested.shown.clips[2].weight, 0.4F, 1e-6F);
  EXPECT_EQ(show_actor(actor, player, 750'000).shown.clips.size(), 1U) << "c hides both, though b was not yet there";
}

TEST(PlayerFade, IsCutShortWhereThereAreTooMany) {
  const model::ActorPtr actor = three_clips();
  Player player = playing_a(actor);
  std::uint64_t jumps = player.jumps;
  for (std::size_t i = 0; i < model::kMostFades; ++i) fade_to(player, actor, i % 2 == 0 ? "b" : "a", 10.0, kSecond);
  EXPECT_EQ(player.jumps, jumps);
  fade_to(player, actor, "c", 10.0, 2 * kSecond);
  EXPECT_EQ(player.fades.size(), model::kMostFades);
  EXPECT_EQ(player.jumps, jumps + 1);
  EXPECT_EQ(show_actor(actor, player, 2 * kSecond).shown.clips.size(), model::kMostFades + 1);
}

TEST(PlayerFade, EndsWithSeekAndStop) {
  const model::ActorPtr actor = three_clips();
  Player faded = playing_a(actor);
  fade_to(faded, actor, "b", 1.0, 0);
  Player sought = faded;
  sought.seek({0.0, 2.0}, 1.0, 100'000);
  EXPECT_TRUE(sought.fades.empty());
  Player stopped = faded;
  stopped.stop({0.0, 2.0}, 100'000);
  EXPECT_TRUE(stopped.fades.empty());
}

TEST(PlayerFade, LosesAClipThatIsRemoved) {
  const model::ActorPtr actor = three_clips();
  Player player = playing_a(actor);
  fade_to(player, actor, "b", 1.0, 0);
  fade_to(player, actor, "c", 1.0, 100'000);
  auto without_a = std::make_shared<model::Actor>(*actor);
  without_a->clips.erase(without_a->clips.begin());
  player.follow_fades(*actor, *without_a, 200'000);
  ASSERT_EQ(player.fades.size(), 1U);
  EXPECT_EQ(player.fades[0].from.clip, "b");
}

TEST(PlayerFade, IntoAClipOfAQueueBeginsAtItsSeam) {
  const model::ActorPtr actor = three_clips();
  Player player;
  player.actor = actor->name;
  player.clip = "a";
  player.start_queue(*actor, {{.clip = "a", .loop = Loop::Repeat}, {.clip = "b", .fade_s = 0.5}}, 0);
  const std::uint64_t continuity = show_actor(actor, player, 1'900'000).continuity;
  const ActorShow show = show_actor(actor, player, 2'250'000);
  ASSERT_EQ(show.shown.clips.size(), 2U);
  EXPECT_NEAR(show.shown.clips[0].time_s, 0.25, 1e-9) << "a repeat goes on around";
  EXPECT_NEAR(show.shown.clips[1].weight, 0.5F, 1e-6F);
  EXPECT_EQ(show.continuity, continuity);
}

// Layers

model::ClipPtr poses(const char* name, double length_s) {
  auto clip = std::make_shared<model::Clip>();
  clip->name = name;
  for (const double t : {0.0, length_s}) {
    clip->times_s.push_back(t);
    clip->keyframes.push_back({static_cast<model::KeyframeId>(clip->times_s.size()),
                               {},
                               {},
                               nullptr,
                               std::make_shared<const model::PoseKey>(std::vector<model::KeyedValue>{})});
  }
  return clip;
}

model::ActorPtr layered(std::vector<model::Layer> layers) {
  auto actor = std::make_shared<model::Actor>();
  actor->name = "actor";
  actor->model = std::make_shared<const model::Model>(model::Model{{}, {}, *model::Skeleton::make({{"root", -1, {}}}), {}, {}});
  actor->clips = {poses("base", 2.0), poses("wave", 0.75)};
  actor->layers = std::move(layers);
  return actor;
}

model::Layer layer(const char* name, float weight) { return {name, "wave", weight, false, nullptr, nullptr}; }

Player on_base() {
  Player player;
  player.actor = "actor";
  player.clip = "base";
  player.play({0.0, 2.0}, 0);
  return player;
}

TEST(LayerTime, RunsWithThePlayerWrappedByItsOwnClip) {
  const model::ActorPtr actor = layered({layer("l", 0.5F)});
  Player player = on_base();
  const auto time_s = [&](ClockUs at) { return show_actor(actor, player, at).shown.layers.at(0).time_s; };
  EXPECT_NEAR(time_s(kSecond), 0.25, 1e-9);
  EXPECT_NEAR(time_s(3 * kSecond), 0.0, 1e-9) << "the player's own wrap is none of the layer's";
  player.set_speed({0.0, 2.0}, -2.0, 3'500'000);
  EXPECT_NEAR(time_s(3'600'000), 0.3, 1e-9) << "backwards";
  player.seek({0.0, 2.0}, 1.75, 4 * kSecond);
  EXPECT_NEAR(time_s(4 * kSecond), 0.25, 1e-9) << "from the sought time";
  player.pause({0.0, 2.0}, 4 * kSecond);
  EXPECT_NEAR(time_s(9 * kSecond), 0.25, 1e-9);
  player.stop({0.0, 2.0}, 9 * kSecond);
  EXPECT_NEAR(time_s(9 * kSecond), 0.0, 1e-9);
}

TEST(LayerTime, JumpsWhereAnOpenClipWraps) {
  const model::ActorPtr actor = layered({layer("l", 1.0F)});
  const Player player = on_base();
  EXPECT_EQ(show_actor(actor, player, 0).continuity, show_actor(actor, player, 749'000).continuity);
  EXPECT_NE(show_actor(actor, player, 749'000).continuity, show_actor(actor, player, 751'000).continuity);
}

TEST(LayerFade, TakesTheWeightFromWhatItWasToWhatItIs) {
  const model::ActorPtr before = layered({});
  const model::ActorPtr after = layered({layer("l", 0.8F)});
  Player player = on_base();
  player.fade_layer("l", nullptr, &after->layers[0], 1.0, kSecond);
  const auto weight = [&](const model::ActorPtr& actor, ClockUs at) {
    const auto& layers = show_actor(actor, player, at).shown.layers;
    return layers.empty() ? 0.0F : layers[0].weight;
  };
  EXPECT_EQ(weight(after, kSecond), 0.0F);
  EXPECT_NEAR(weight(after, 1'500'000), 0.4F, 1e-6F);
  EXPECT_NEAR(weight(after, 2 * kSecond), 0.8F, 1e-6F);
  const model::ActorPtr less = layered({layer("l", 0.2F)});
  player.fade_layer("l", &after->layers[0], &less->layers[0], 1.0, 1'500'000);
  EXPECT_NEAR(weight(less, 1'500'000), 0.4F, 1e-6F) << "from where it was";
  EXPECT_NEAR(weight(less, 2 * kSecond), 0.3F, 1e-6F);
  player.fade_layer("l", &less->layers[0], nullptr, 1.0, 2'500'000);
  EXPECT_NEAR(weight(before, 3 * kSecond), 0.1F, 1e-6F) << "removed, and on its way out";
  EXPECT_TRUE(show_actor(before, player, 3 * kSecond).moving);
  EXPECT_EQ(weight(before, 3'500'000), 0.0F);
}

TEST(LayerFade, KeepsTheOrderOfNames) {
  const model::ActorPtr actor = layered({layer("a", 1.0F), layer("c", 1.0F)});
  const model::Layer gone = layer("b", 0.5F);
  Player player = on_base();
  player.fade_layer("b", &gone, nullptr, 1.0, 0);
  const ActorShow show = show_actor(actor, player, 500'000);
  ASSERT_EQ(show.shown.layers.size(), 3U);
  EXPECT_NEAR(show.shown.layers[1].weight, 0.25F, 1e-6F);
}

TEST(LayerFade, OfAnotherClipIsOneOutAndOneIn) {
  model::Layer other = layer("l", 1.0F);
  other.additive = true;
  const model::ActorPtr actor = layered({other});
  const model::Layer was = layer("l", 1.0F);
  Player player = on_base();
  player.fade_layer("l", &was, &actor->layers[0], 1.0, 0);
  const ActorShow show = show_actor(actor, player, 250'000);
  ASSERT_EQ(show.shown.layers.size(), 2U);
  EXPECT_FALSE(show.shown.layers[0].additive);
  EXPECT_NEAR(show.shown.layers[0].weight, 0.75F, 1e-6F);
  EXPECT_NEAR(show.shown.layers[1].weight, 0.25F, 1e-6F);
}

TEST(LayerFade, ShowsNoMoreThanThereIsRoomFor) {
  std::vector<model::Layer> layers;
  for (char c = 'a'; c < 'a' + 16; ++c) layers.push_back(layer(std::string(1, c).c_str(), 1.0F));
  const model::ActorPtr actor = layered(layers);
  Player player = on_base();
  for (int i = 0; i < 40; ++i) {
    const model::Layer gone = layer(("ghost" + std::to_string(i)).c_str(), 1.0F);
    player.fade_layer(gone.name, &gone, nullptr, 10.0, 0);
  }
  EXPECT_EQ(show_actor(actor, player, kSecond).shown.layers.size(), model::kMostLayers);
}

TEST(ShowActor, TakesNoMemoryHoweverMuchFades) {
  std::vector<model::Layer> layers;
  for (char c = 'a'; c < 'a' + 16; ++c) layers.push_back(layer(std::string(1, c).c_str(), 1.0F));
  const model::ActorPtr actor = layered(layers);
  Player player = on_base();
  for (int i = 0; i < 16; ++i) {
    const model::Layer gone = layer(("a ghost with a long name " + std::to_string(i)).c_str(), 1.0F);
    player.fade_layer(gone.name, &gone, nullptr, 10.0, 0);
  }
  for (std::size_t i = 0; i < model::kMostFades; ++i) fade_to(player, actor, i % 2 == 0 ? "wave" : "base", 10.0, 0);
  ActorShow show;
  const std::size_t before = test::allocations();
  for (ClockUs at = 0; at < kSecond; at += 10'000) show = show_actor(actor, player, at);
  EXPECT_EQ(test::allocations(), before);
  EXPECT_EQ(show.shown.clips.size(), model::kMostFades + 1);
}

}  // namespace
}  // namespace tweend::stage
