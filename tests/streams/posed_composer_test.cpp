#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <vector>

#include "server/model/evaluate.hpp"
#include "server/streams/frame_composer.hpp"
#include "tests/streams/posed_actors.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/scenes.hpp"

// Which of the three ways an actor's moment is drawn in, and what is drawn of its skeleton.

namespace tweend::streams {
namespace {

using model::Shown;
using test::ribbon_actor;

constexpr render::Size kWide{200, 100};

stage::ActorShow show_of(const model::ActorPtr& actor, Shown shown) {
  stage::ActorShow show;
  show.actor = actor;
  show.clip = shown.clips.back().clip;
  show.time_s = shown.clips.back().time_s;
  show.shown = std::move(shown);
  return show;
}

stage::Show show_of(const std::vector<stage::ActorShow>& actors) {
  stage::Show show;
  std::vector<model::ActorPtr> of_scene;
  for (const stage::ActorShow& a : actors) of_scene.push_back(a.actor);
  show.scene = test::scene_of("main", std::move(of_scene));
  show.actors = actors;
  return show;
}

/// A clip, and one that has faded in over it as far as `weight`.
Shown fade(const model::Actor& actor, const char* from, double from_s, const char* to, double to_s, float weight) {
  Shown shown = model::shown_clip(actor.find_clip(from), from_s);
  shown.clips.push_back({actor.find_clip(to), to_s, weight});
  return shown;
}

class PosedComposer : public testing::Test {
 protected:
  const render::Picture& compose(const model::ActorPtr& actor, Shown shown) {
    composer_.compose(show_of({show_of(actor, std::move(shown))}), {}, kWide, picture_);
    return picture_;
  }
  /// What the item's keyframes make, in double, beside the processor's vertices.
  void expect_blend_of(const render::DrawItem& item, const model::Actor& actor, const Shown& shown) {
    std::vector<float> expected(3 * actor.model->vertex_count());
    ASSERT_TRUE(model::Evaluator().vertices(actor, shown, {expected, {}, {}}));
    double sum = 0.0;
    for (std::uint32_t k = 0; k < item.key_count; ++k) sum += static_cast<double>(item.weight[k]);
    EXPECT_NEAR(sum, 1.0, 1e-6);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      double found = 0.0;
      for (std::uint32_t k = 0; k < item.key_count; ++k) {
        found += static_cast<double>(item.weight[k]) * static_cast<double>(item.key[k].block[i]);
      }
      EXPECT_NEAR(found, static_cast<double>(expected[i]), 1e-6);
    }
  }
  FrameComposer composer_;
  render::Picture picture_;
  const std::shared_ptr<model::Actor> actor_ = ribbon_actor("ribbon");
};

TEST_F(PosedComposer, APoseIsTheRestShapeWithItsPaletteAndWeights) {
  const render::DrawItem& item = compose(actor_, model::shown_clip(actor_->find_clip("bend"), 0.5)).items.at(0);
  EXPECT_EQ(item.key_count, 1U);
  EXPECT_EQ(item.key[0].block.data(), actor_->model->rest->block().data());
  EXPECT_TRUE(item.vertices.empty());
  ASSERT_EQ(item.palette.size(), 12 * test::kRibbonJoints);
  ASSERT_EQ(item.morph_weights.size(), 2U);
  EXPECT_NEAR(item.morph_weights[0], 0.2F, 1e-6F);
  EXPECT_NEAR(item.morph_weights[1], 0.35F, 1e-6F);
  // Halfway to 0.9 rad each; the second entry: up to its joint, turned, and the inverse bind matrix back down.
  const glm::mat4 up = glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, 0.5F, 0.0F));
  const glm::mat4 expected = glm::rotate(up, 0.45F, glm::vec3(0, 0, 1)) * glm::inverse(up);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      EXPECT_NEAR(item.palette[static_cast<std::size_t>(12 + 4 * row + column)], expected[column][row], 1e-5F);
    }
  }
}

TEST_F(PosedComposer, ALivePoseIsDrawnAtOnce) {
  Shown shown = model::shown_clip(actor_->find_clip("bend"), 0.0);
  shown.live = std::make_shared<const model::PoseKey>(
      std::vector<model::KeyedValue>{{{0, animation::Property::Translation}, {3.0F, 4.0F, 5.0F, 0.0F}}});
  const render::DrawItem& item = compose(actor_, shown).items.at(0);
  EXPECT_NEAR(item.palette[3], 3.0F, 1e-6F);
  EXPECT_NEAR(item.palette[7], 4.0F, 1e-6F);
  EXPECT_NEAR(item.palette[11], 5.0F, 1e-6F);
}

TEST_F(PosedComposer, AClipOfVerticesLeavesTheSkinAside) {
  const Shown shown = model::shown_clip(actor_->find_clip("slide"), 0.5);
  const render::DrawItem& item = compose(actor_, shown).items.at(0);
  EXPECT_TRUE(item.palette.empty());
  EXPECT_TRUE(item.morph_weights.empty());
  EXPECT_EQ(item.key_count, 2U);
  expect_blend_of(item, *actor_, shown);
}

TEST_F(PosedComposer, ClipsOfVerticesThatFadeAreOneBlendOfFourKeyframes) {
  for (const float weight : {0.0F, 0.3F, 0.8F, 1.0F}) {
    const Shown shown = fade(*actor_, "slide", 0.25, "drift", 2.75, weight);
    const render::DrawItem& item = compose(actor_, shown).items.at(0);
    EXPECT_TRUE(item.vertices.empty());
    EXPECT_EQ(item.key_count, weight == 0.0F || weight == 1.0F ? 2U : 4U);
    EXPECT_EQ(item.keys_expected, 8U);
    expect_blend_of(item, *actor_, shown);
  }
}

TEST_F(PosedComposer, KeyframesThatBothClipsShowTakeOnePlace) {
  Shown shown = fade(*actor_, "drift", 0.25, "drift", 1.5, 0.4F);
  shown.clips.push_back({actor_->find_clip("drift"), 2.5, 0.5F});
  const render::DrawItem& item = compose(actor_, shown).items.at(0);
  EXPECT_TRUE(item.vertices.empty());
  EXPECT_EQ(item.key_count, 4U);
  expect_blend_of(item, *actor_, shown);
}

TEST_F(PosedComposer, MoreKeyframesThanFourAreBlendedHere) {
  actor_->settings.interpolation = animation::Interpolation::CatmullRom;
  const Shown shown = fade(*actor_, "drift", 1.5, "slide", 0.5, 0.5F);
  const render::DrawItem& item = compose(actor_, shown).items.at(0);
  const std::size_t stream = 3 * actor_->model->vertex_count();
  ASSERT_EQ(item.vertices.size(), actor_->model->rest->block().size());
  std::vector<float> positions(stream), normals(stream);
  ASSERT_TRUE(model::Evaluator().vertices(*actor_, shown, {positions, normals, {}}));
  EXPECT_TRUE(std::equal(positions.begin(), positions.end(), item.vertices.begin()));
  EXPECT_TRUE(std::equal(normals.begin(), normals.end(), item.vertices.begin() + static_cast<std::ptrdiff_t>(stream)));
}

TEST_F(PosedComposer, AMixOfBothKindsIsBlendedHere) {
  const Shown shown = fade(*actor_, "bend", 0.5, "slide", 0.5, 0.5F);
  const render::DrawItem& item = compose(actor_, shown).items.at(0);
  std::vector<float> positions(3 * actor_->model->vertex_count());
  ASSERT_TRUE(model::Evaluator().vertices(*actor_, shown, {positions, {}, {}}));
  ASSERT_FALSE(item.vertices.empty());
  EXPECT_TRUE(std::equal(positions.begin(), positions.end(), item.vertices.begin()));
}

TEST_F(PosedComposer, WhatDeformsAMeshIsPartOfItsName) {
  const auto source_of = [this](const test::RibbonParts& parts) {
    const model::ActorPtr actor = ribbon_actor("a", parts);
    return compose(actor, model::shown_clip(actor->clips.front(), 0.0)).items.at(0).mesh;
  };
  const auto whole = source_of({}), again = source_of({}), bare = source_of({.skinned = false, .morphed = false});
  EXPECT_EQ(whole->id, again->id);
  EXPECT_NE(whole->id, bare->id);
  EXPECT_NE(whole->id, source_of({.morphed = false})->id);
  EXPECT_NE(whole->id, source_of({.skinned = false})->id);
  EXPECT_EQ(whole->skin.per_vertex, 4U);
  EXPECT_EQ(whole->skin.entries.size(), 4 * whole->vertex_count);
  EXPECT_EQ(whole->skin.weights.size(), 4 * whole->vertex_count);
  ASSERT_EQ(whole->morphs.size(), 2U);
  EXPECT_EQ(whole->morphs[1].positions.size(), 3 * whole->vertex_count);
  EXPECT_TRUE(whole->morphs[1].normals.empty());
  EXPECT_EQ(bare->skin.per_vertex, 0U);
  EXPECT_TRUE(bare->morphs.empty());
}

TEST_F(PosedComposer, TellsOfMaterialsAllThatTheyAre) {
  model::Material material;
  material.base_color_texture = *model::Image::make(1, 1, {1, 2, 3, 4});
  material.wrap_u = model::TextureWrap::MirroredRepeat;
  material.wrap_v = model::TextureWrap::ClampToEdge;
  material.alpha = 0.75F;
  material.alpha_cutoff = 0.25F;
  material.unlit = true;
  auto model = std::make_shared<model::Model>();
  model->mesh = *model::Mesh::make(3, {0, 1, 2}, {0, 0, 1, 0, 1, 1}, {{material}, {{0, 3, 0}}}, std::vector<float>(12, 0.5F));
  model->rest = *model::VertexKey::make(*model->mesh, std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0});
  const auto actor = std::make_shared<model::Actor>(*test::square_actor("painted"));
  actor->model = model;
  const auto& source =
      *compose(actor, model::shown_clip(test::square_actor("x", {{.keys = 0}})->clips.front(), 0.0)).items.at(0).mesh;
  EXPECT_EQ(source.colors.data(), model->mesh->colors().data());
  const render::MaterialSource& m = source.materials.at(0);
  ASSERT_TRUE(m.base_color_texture);
  EXPECT_EQ(m.wrap_u, render::TextureWrap::MirroredRepeat);
  EXPECT_EQ(m.wrap_v, render::TextureWrap::ClampToEdge);
  EXPECT_EQ(m.alpha, 0.75F);
  EXPECT_EQ(m.alpha_cutoff, 0.25F);
  EXPECT_TRUE(m.unlit);
}

TEST_F(PosedComposer, AnActorWithoutAMeshIsItsBones) {
  const auto actor = test::bones_actor("bones", {{"hand", 2, {.translation = {0, 0, 0.25F}}},
                                                 {"root", -1, {}},
                                                 {"arm", 1, {.translation = {0, 1, 0}}},
                                                 {"same", 2, {}},
                                                 {"other root", -1, {.translation = {5, 0, 0}}}});
  actor->settings.transform.scale = glm::vec3(2.0F);
  actor->settings.transform.translation = {0.0F, 0.0F, 1.0F};
  const render::Picture& picture = compose(actor, model::shown_clip(actor->clips.front(), 0.0));
  EXPECT_TRUE(picture.items.empty());
  EXPECT_TRUE(picture.bones_over.empty());
  ASSERT_EQ(picture.bones.size(), 5U);
  const auto& skeleton = *actor->model->skeleton;
  const auto bone = [&](const char* name) { return picture.bones[skeleton.place_of(*skeleton.find(name))]; };
  EXPECT_EQ(bone("root").joint, glm::vec3(0, 0, 1));
  EXPECT_EQ(bone("root").parent, bone("root").joint);
  EXPECT_EQ(bone("arm").joint, glm::vec3(0, 2, 1));
  EXPECT_EQ(bone("arm").parent, bone("root").joint);
  EXPECT_EQ(bone("hand").joint, glm::vec3(0, 2, 1.5F));
  EXPECT_EQ(bone("same").joint, bone("same").parent) << "no length, no bone";
  EXPECT_GT(bone("same").radius, 0.0F);
  EXPECT_FLOAT_EQ(bone("root").radius, bone("arm").radius) << "the longer of its bones says";
  EXPECT_FLOAT_EQ(bone("root").radius, 4.0F * bone("hand").radius) << "it follows the length";
  EXPECT_GT(bone("other root").radius, 0.0F);
  for (const char* name : {"arm", "hand"}) {
    const render::BoneSource b = bone(name);
    EXPECT_NEAR(glm::length(b.side), 1.0F, 1e-6F);
    EXPECT_NEAR(glm::dot(b.side, glm::normalize(b.joint - b.parent)), 0.0F, 1e-6F);
  }
}

TEST_F(PosedComposer, OneRootAtTheOriginStillShows) {
  const auto actor = test::bones_actor("bones", {{"root", -1, {}}});
  const render::Picture& picture = compose(actor, model::shown_clip(actor->clips.front(), 0.0));
  ASSERT_EQ(picture.bones.size(), 1U);
  EXPECT_GT(picture.bones[0].radius, 0.005F * picture.view.focus_m);
  EXPECT_LT(picture.bones[0].radius, 0.1F * picture.view.focus_m);
}

TEST_F(PosedComposer, ABoneTurnsWithItsParentJoint) {
  const auto side_at = [this](float angle) {
    const animation::JointPose turned{.rotation = glm::angleAxis(angle, glm::vec3(0, 1, 0))};
    const auto actor = test::bones_actor("bones", {{"root", -1, turned}, {"up", 0, {.translation = {0, 1, 0}}}});
    return compose(actor, model::shown_clip(actor->clips.front(), 0.0)).bones.at(1).side;
  };
  const glm::vec3 a = side_at(0.0F), b = side_at(0.5F);
  EXPECT_NEAR(glm::dot(a, b), std::cos(0.5F), 1e-5F);
}

TEST_F(PosedComposer, ASkeletonIsShownOverItsMeshWhereItIsAskedFor) {
  const Shown posed = model::shown_clip(actor_->find_clip("bend"), 1.0);
  EXPECT_TRUE(compose(actor_, posed).bones_over.empty());
  actor_->settings.show_skeleton = true;
  for (const Shown& shown :
       {posed, model::shown_clip(actor_->find_clip("slide"), 1.0), fade(*actor_, "bend", 0.5, "slide", 0.5, 0.5F)}) {
    const render::Picture& picture = compose(actor_, shown);
    EXPECT_EQ(picture.items.size(), 1U);
    EXPECT_TRUE(picture.bones.empty());
    ASSERT_EQ(picture.bones_over.size(), test::kRibbonJoints);
  }
  const glm::vec3 tip = compose(actor_, posed).bones_over[2].joint;
  EXPECT_NEAR(tip.x, -0.5F * std::sin(0.9F), 1e-5F);
  EXPECT_NEAR(tip.y, 0.5F + 0.5F * std::cos(0.9F), 1e-5F);
  actor_->settings.visible = false;
  EXPECT_TRUE(compose(actor_, posed).bones_over.empty());
}

TEST_F(PosedComposer, AllocatesNothingOnceWarm) {
  actor_->settings.show_skeleton = true;
  const auto spline = ribbon_actor("spline");
  spline->settings.interpolation = animation::Interpolation::CatmullRom;
  const auto bones = test::bones_actor("bones", {{"root", -1, {}}, {"up", 0, {.translation = {0, 1, 0}}}});
  std::vector<stage::Show> shows;
  for (const double time_s : {0.0, 0.25, 0.5, 1.0}) {
    shows.push_back(show_of({show_of(actor_, model::shown_clip(actor_->find_clip("bend"), time_s)),
                             show_of(ribbon_actor("fading"), fade(*actor_, "bend", time_s, "twist", 0.5, 0.3F)),
                             show_of(spline, fade(*spline, "drift", 1.0 + time_s, "slide", time_s, 0.5F)),
                             show_of(ribbon_actor("mixed"), fade(*actor_, "bend", time_s, "slide", 0.5, 0.5F)),
                             show_of(bones, model::shown_clip(bones->clips.front(), 0.0))}));
  }
  for (std::size_t i = 1; i < shows.size(); ++i) {
    for (std::size_t a = 0; a < shows[i].actors.size(); ++a) shows[i].actors[a].actor = shows[0].actors[a].actor;
  }
  for (const stage::Show& show : shows) composer_.compose(show, {}, kWide, picture_);
  const std::size_t before = test::allocations();
  for (const stage::Show& show : shows) composer_.compose(show, {}, kWide, picture_);
  EXPECT_EQ(test::allocations() - before, 0U);
}

}  // namespace
}  // namespace tweend::streams
