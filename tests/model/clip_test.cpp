#include "server/model/clip.hpp"

#include <gtest/gtest.h>

namespace tweend::model {
namespace {

Clip clip_at(std::vector<double> times_s, bool closed = false, std::optional<double> duration_s = {}) {
  Clip clip;
  clip.settings = {closed, duration_s, {}};
  for (std::size_t i = 0; i < times_s.size(); ++i) clip.keyframes.push_back({static_cast<KeyframeId>(10 + i), {}, {}, nullptr});
  clip.times_s = std::move(times_s);
  return clip;
}

TEST(Clip, AnOpenOneEndsWithItsLastKeyframe) {
  EXPECT_EQ(clip_at({}).duration_s(), 0.0);
  EXPECT_EQ(clip_at({2.0}).duration_s(), 2.0);
  EXPECT_EQ(clip_at({1.0, 2.5}).duration_s(), 2.5);
}

TEST(Clip, AClosedOneEndsAMeanSpacingLater) {
  EXPECT_EQ(clip_at({}, true).duration_s(), 0.0);
  EXPECT_EQ(clip_at({0.0, 1.0, 2.0, 3.0}, true).duration_s(), 4.0);
  EXPECT_EQ(clip_at({1.0, 1.5, 5.0}, true).duration_s(), 7.0);
  EXPECT_EQ(clip_at({0.0}, true).duration_s(), 1.0);
}

TEST(Clip, AnExplicitDurationIsTaken) {
  EXPECT_EQ(clip_at({0.0, 1.0}, true, 9.0).duration_s(), 9.0);
  EXPECT_EQ(clip_at({}, false, 9.0).duration_s(), 9.0);
}

TEST(Clip, FindsKeyframesByIdAndPlacesByTime) {
  const Clip clip = clip_at({0.0, 1.0, 2.0});
  EXPECT_EQ(clip.index_of(11), 1U);
  EXPECT_EQ(clip.index_of(99), std::nullopt);
  EXPECT_EQ(clip.place_of(-1.0), 0U);
  EXPECT_EQ(clip.place_of(1.0), 1U);
  EXPECT_EQ(clip.place_of(1.5), 2U);
  EXPECT_EQ(clip.place_of(5.0), 3U);
}

TEST(Clip, ItsTypeIsThatOfItsKeyframesElseTheDeclaredOne) {
  Clip empty;
  EXPECT_EQ(empty.type(), ClipType::None);
  empty.declared_type = ClipType::Vertex;
  EXPECT_EQ(empty.type(), ClipType::Vertex);
  Clip keyed = clip_at({0.0});
  keyed.declared_type = ClipType::Vertex;
  keyed.keyframes.front().pose = std::make_shared<const PoseKey>(std::vector<KeyedValue>{});
  EXPECT_EQ(keyed.type(), ClipType::Skeletal);
  const MeshPtr mesh = *Mesh::make(3, {0, 1, 2});
  keyed.keyframes.front() = {1, {}, {}, *VertexKey::make(*mesh, std::vector<float>(9, 0.0F))};
  EXPECT_EQ(keyed.type(), ClipType::Vertex);
}

}  // namespace
}  // namespace tweend::model
