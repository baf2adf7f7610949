#include "server/model/actor.hpp"

#include <gtest/gtest.h>

#include <array>
#include <glm/vec4.hpp>
#include <memory>
#include <numbers>

#include "server/model/evaluate.hpp"

namespace tweend::model {
namespace {

using animation::Interpolation;

MeshPtr triangle() { return *Mesh::make(3, {0, 1, 2}); }

/// A triangle lifted by so many metres.
VertexKeyPtr lifted(float y) { return *VertexKey::make(*triangle(), std::vector<float>{0, y, 0, 0, y, 1, 1, y, 0}); }

Actor actor_with(std::vector<float> heights, Clip clip = {}) {
  clip.name = "default";
  for (std::size_t i = 0; i < heights.size(); ++i) {
    clip.times_s.push_back(static_cast<double>(i));
    clip.keyframes.push_back({static_cast<KeyframeId>(i + 1), {}, {}, lifted(heights[i])});
  }
  auto model = std::make_shared<const Model>(Model{triangle(), lifted(-1), {}, {}, {}});
  return {"a", "mesh", std::move(model), {}, {std::make_shared<const Clip>(std::move(clip))}, {}};
}

float height_at(const Actor& actor, double time_s) {
  std::array<float, 9> positions{}, normals{};
  EXPECT_TRUE(Evaluator().vertices(actor, shown_clip(actor.clips.front(), time_s), {positions, normals, {}}));
  return positions[1];
}

TEST(SampleVertices, AClipWithoutKeyframesShowsTheRestShape) { EXPECT_EQ(height_at(actor_with({}), 0.7), -1.0F); }

TEST(SampleVertices, KeyframesAreExactAndTimesOutsideAreHeld) {
  const Actor actor = actor_with({0.1F, 5.3F, 2.2F});
  EXPECT_EQ(height_at(actor, 0), 0.1F);
  EXPECT_EQ(height_at(actor, 1), 5.3F);
  EXPECT_EQ(height_at(actor, 2), 2.2F);
  EXPECT_EQ(height_at(actor, 99), 2.2F);
  EXPECT_EQ(height_at(actor, -99), 0.1F);
}

TEST(SampleVertices, TheModeIsTheKeyframesElseTheActorsElseTheClipsElseLinear) {
  Clip clip;
  EXPECT_FLOAT_EQ(height_at(actor_with({0, 4}), 0.25), 1.0F);
  clip.settings.interpolation = Interpolation::Step;
  Actor actor = actor_with({0, 4}, clip);
  EXPECT_FLOAT_EQ(height_at(actor, 0.25), 0.0F);
  actor.settings.interpolation = Interpolation::Linear;
  EXPECT_FLOAT_EQ(height_at(actor, 0.25), 1.0F);
  Clip own = *actor.clips.front();
  own.keyframes.front().interpolation = Interpolation::Step;
  actor.clips.front() = std::make_shared<const Clip>(own);
  EXPECT_FLOAT_EQ(height_at(actor, 0.25), 0.0F);
}

TEST(SampleVertices, EasingBendsTheBlend) {
  Actor actor = actor_with({0, 4});
  Clip eased = *actor.clips.front();
  eased.keyframes.front().easing = animation::CubicBezier{0.0, 0.0, 0.0, 0.0};  // y = t³ where x = t³: a straight line
  actor.clips.front() = std::make_shared<const Clip>(eased);
  // x(t) = t³ and y(t) = t³: the identity, by another way.
  EXPECT_NEAR(height_at(actor, 0.25), 1.0F, 1e-5);
}

TEST(SampleVertices, WrongLengthsAreRefused) {
  std::array<float, 8> positions{};
  const Actor actor = actor_with({0, 1});
  const Status status = Evaluator().vertices(actor, shown_clip(actor.clips.front(), 0.5), {positions, {}, {}});
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::Internal);
}

TEST(WorldFromModel, ScalesThenSpinsThenTurnsThenMoves) {
  Transform t;
  t.translation = {10, 0, 0};
  t.scale = {2, 1, 1};
  const float quarter = std::numbers::pi_v<float> / 2;
  // A quarter turn about +Y takes +X to -Z.
  const glm::vec4 spun = world_from_model(t, quarter) * glm::vec4(1, 0, 0, 1);
  EXPECT_NEAR(spun.x, 10, 1e-5);
  EXPECT_NEAR(spun.z, -2, 1e-5);
  t.rotation = glm::angleAxis(quarter, glm::vec3(1, 0, 0));  // takes +Y to +Z, -Z to +Y
  const glm::vec4 both = world_from_model(t, quarter) * glm::vec4(1, 0, 0, 1);
  EXPECT_NEAR(both.y, 2, 1e-5);
}

}  // namespace
}  // namespace tweend::model
