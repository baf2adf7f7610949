#include "server/model/evaluate.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "server/model/actor_bounds.hpp"

namespace tweend::model {
namespace {

using animation::Channel;
using animation::Property;

// An arm along +Y: a shoulder at the origin and an elbow a metre above it, skinned to three points (two at the shoulder's side,
// one at the tip), with a morph target that widens the tip.

glm::vec4 about_z(double angle) {
  return {0, 0, static_cast<float>(std::sin(angle / 2)), static_cast<float>(std::cos(angle / 2))};
}

ModelPtr arm() {
  Joint shoulder{"shoulder", -1, {}}, elbow{"elbow", 0, {}};
  elbow.rest.translation = {0, 1, 0};
  const MeshPtr mesh = *Mesh::make(3, {0, 1, 2});
  const std::vector<float> positions{-0.5F, 0, 0, 0.5F, 0, 0, 0, 2, 0};
  animation::Affine elbow_from_mesh;
  elbow_from_mesh.rows[1].w = -1;
  const SkinPtr skin = *Skin::make({{0, {}}, {1, elbow_from_mesh}}, 1, {0, 0, 1}, {1, 1, 1}, positions);
  const MorphTargetsPtr morphs = *MorphTargets::make({{"wide", 0.0F, 2, {1, 0, 0}, {}, {}}}, 3);
  return std::make_shared<const Model>(
      Model{mesh, *VertexKey::make(*mesh, positions), *Skeleton::make({shoulder, elbow}), skin, morphs});
}

ClipPtr posed(std::string name, std::vector<std::pair<double, std::vector<KeyedValue>>> keys) {
  Clip clip;
  clip.name = std::move(name);
  for (auto& [time_s, values] : keys) {
    clip.times_s.push_back(time_s);
    clip.keyframes.push_back(
        {static_cast<KeyframeId>(clip.times_s.size()), {}, {}, {}, std::make_shared<const PoseKey>(values)});
  }
  return std::make_shared<const Clip>(std::move(clip));
}

ClipPtr bend() {
  return posed("bend", {{0.0, {{{1, Property::Rotation}, about_z(0)}}}, {1.0, {{{1, Property::Rotation}, about_z(1.0)}}}});
}

/// A clip of whole meshes, all at one height.
ClipPtr lifted(const Model& model, float y) {
  Clip clip;
  clip.name = "lifted";
  clip.times_s = {0.0};
  clip.keyframes.push_back({9, {}, {}, *VertexKey::make(*model.mesh, std::vector<float>{0, y, 0, 1, y, 0, 0, y, 1})});
  return std::make_shared<const Clip>(std::move(clip));
}

Actor actor_with(std::vector<ClipPtr> clips) { return {"a", "test", arm(), {}, std::move(clips), {}}; }

double elbow_angle(const Actor& actor, const Shown& shown) {
  Evaluator evaluator;
  const animation::Pose& pose = evaluator.pose(actor, shown);
  const glm::quat q = pose.joint(actor.model->skeleton->place_of(1)).rotation;
  return 2 * std::atan2(static_cast<double>(q.z), static_cast<double>(q.w));
}

std::array<float, 9> positions_of(const Actor& actor, const Shown& shown) {
  std::array<float, 9> positions{}, normals{};
  EXPECT_TRUE(Evaluator().vertices(actor, shown, {positions, normals, {}}));
  return positions;
}

TEST(Evaluator, AClipWithoutKeyframesShowsTheRestPose) {
  const Actor actor = actor_with({posed("default", {})});
  Evaluator evaluator;
  const auto matrices = evaluator.model_from_joint(actor, shown_clip(actor.clips[0], 0.0));
  EXPECT_EQ(matrices[1].rows[1].w, 1.0F);
  EXPECT_EQ(positions_of(actor, shown_clip(actor.clips[0], 0.0))[7], 2.0F);
}

TEST(Evaluator, BonesCarryTheirVertices) {
  const Actor actor = actor_with({bend()});
  for (const double t : {0.0, 0.25, 0.5, 1.0}) {
    const auto at = positions_of(actor, shown_clip(actor.clips[0], t));
    EXPECT_NEAR(at[6], -std::sin(t), 1e-6) << t;
    EXPECT_NEAR(at[7], 1 + std::cos(t), 1e-6) << t;
    EXPECT_EQ(at[0], -0.5F);
  }
}

TEST(Evaluator, MorphsComeBeforeBones) {
  const Actor actor = actor_with(
      {posed("both", {{0.0, {{{1, Property::Rotation}, about_z(M_PI / 2)}, {{0, Property::Weight}, {0.5F, 0, 0, 0}}}}})});
  const auto at = positions_of(actor, shown_clip(actor.clips[0], 0.0));
  // (0.5, 1) from the elbow, turned by a quarter: (-1, 0.5).
  EXPECT_NEAR(at[6], -1.0, 1e-6);
  EXPECT_NEAR(at[7], 1.5, 1e-6);
}

TEST(Evaluator, ClipsFadeIntoEachOtherByTheirWeights) {
  const Actor actor = actor_with({bend()});
  Shown shown = shown_clip(actor.clips[0], 0.0);
  shown.clips.push_back({actor.clips[0], 1.0, 0.25F});
  EXPECT_NEAR(elbow_angle(actor, shown), 0.25, 1e-6);
  shown.clips.push_back({actor.clips[0], 0.0, 0.5F});
  EXPECT_NEAR(elbow_angle(actor, shown), 0.125, 1e-6);
  shown.clips.back().weight = 1.0F;
  EXPECT_EQ(elbow_angle(actor, shown), 0.0);
}

TEST(Evaluator, LayersReplaceOrAddWhereTheirMaskLetsThem) {
  const ClipPtr nod = posed("nod", {{0.0, {{{1, Property::Rotation}, about_z(0.4)}}}});
  const Actor actor = actor_with({bend(), nod});
  Shown shown = shown_clip(actor.clips[0], 1.0);
  shown.layers.push_back({nod, 0.0, 0.5F, false, nullptr});
  EXPECT_NEAR(elbow_angle(actor, shown), 0.7, 1e-6);
  shown.layers[0].additive = true;
  EXPECT_NEAR(elbow_angle(actor, shown), 1.2, 1e-6);
  shown.layers[0].mask = std::make_shared<const std::vector<float>>(std::vector<float>{1.0F, 0.0F});
  EXPECT_NEAR(elbow_angle(actor, shown), 1.0, 1e-6);
}

TEST(Evaluator, ALayerSaysNothingOfJointsItsClipDoesNotKey) {
  const ClipPtr move = posed("move", {{0.0, {{{0, Property::Translation}, {5, 0, 0, 0}}}}});
  const Actor actor = actor_with({bend(), move});
  Shown shown = shown_clip(actor.clips[0], 1.0);
  shown.layers.push_back({move, 0.0, 1.0F, false, nullptr});
  EXPECT_NEAR(elbow_angle(actor, shown), 1.0, 1e-6);
  EXPECT_NEAR(positions_of(actor, shown)[0], 4.5, 1e-6);
}

TEST(Evaluator, ALivePoseLiesOverAllElse) {
  const Actor actor = actor_with({bend()});
  Shown shown = shown_clip(actor.clips[0], 1.0);
  shown.live = std::make_shared<const PoseKey>(std::vector<KeyedValue>{{{1, Property::Rotation}, about_z(0.3)}});
  EXPECT_NEAR(elbow_angle(actor, shown), 0.3, 1e-6);
}

TEST(Evaluator, FadesBetweenAPoseAndVerticesBlendWhatComesOut) {
  const Actor actor = actor_with({bend(), lifted(*arm(), 10.0F)});
  Shown shown = shown_clip(actor.clips[0], 0.0);
  shown.clips.push_back({actor.clips[1], 0.0, 0.25F});
  EXPECT_NEAR(positions_of(actor, shown)[7], 0.75 * 2 + 0.25 * 10, 1e-5);
  EXPECT_FALSE(shows_pose(shown));
  EXPECT_FALSE(shows_vertices(shown));
  shown.clips.push_back({actor.clips[0], 0.0, 1.0F});
  EXPECT_NEAR(positions_of(actor, shown)[7], 2.0, 1e-6);
}

TEST(Evaluator, UsedAgainItShowsTheSame) {
  const Actor actor = actor_with({bend(), lifted(*arm(), 10.0F)});
  Evaluator evaluator;
  const auto shown_at = [&](double t) {
    std::array<float, 9> positions{}, normals{};
    Shown shown = shown_clip(actor.clips[0], t);
    if (t > 0.5) shown.clips.push_back({actor.clips[1], 0.0, 0.5F});
    EXPECT_TRUE(evaluator.vertices(actor, shown, {positions, normals, {}}));
    return positions;
  };
  const auto first = shown_at(0.3), second = shown_at(0.8);
  EXPECT_EQ(shown_at(0.3), first);
  EXPECT_EQ(shown_at(0.8), second);
}

TEST(ClipBounds, HoldEverythingThatAPoseShows) {
  const Actor actor = actor_with({bend()});
  const Bounds box = clip_bounds(actor, actor.clips[0]);
  for (int i = 0; i <= 100; ++i) {
    const auto at = positions_of(actor, shown_clip(actor.clips[0], i / 100.0));
    for (std::size_t v = 0; v < 9; v += 3) {
      for (glm::length_t k = 0; k < 3; ++k) {
        EXPECT_GE(at[v + static_cast<std::size_t>(k)], box.min[k] - 1e-3F);
        EXPECT_LE(at[v + static_cast<std::size_t>(k)], box.max[k] + 1e-3F);
      }
    }
  }
}

TEST(ClipBounds, OfASkeletonAloneHoldItsBonesAsTheyAreDrawn) {
  Joint root{"root", -1, {}}, hand{"hand", 0, {}};
  hand.rest.translation = {0, 3, 0};
  const auto model = std::make_shared<const Model>(Model{{}, {}, *Skeleton::make({root, hand}), {}, {}});
  const Actor actor{"a", "skeleton", model, {}, {posed("default", {})}, {}};
  const Bounds bounds = clip_bounds(actor, actor.clips[0]);
  for (int axis = 0; axis < 3; ++axis) {  // a tenth of the bone's length on all sides
    EXPECT_NEAR(bounds.min[axis], -0.3F, 1e-6F);
    EXPECT_NEAR(bounds.max[axis], axis == 1 ? 3.3F : 0.3F, 1e-6F);
  }
}

}  // namespace
}  // namespace tweend::model
