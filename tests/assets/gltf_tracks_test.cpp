#include "server/assets/gltf_tracks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tweend::assets {
namespace {

using ::testing::ElementsAre;
using ::testing::Ge;

std::vector<std::size_t> keys_at(const GltfTimeline& line) {
  std::vector<std::size_t> counts;
  for (const auto& keys : line.keys) counts.push_back(keys.size());
  return counts;
}

TEST(GltfTimeline, IsTheUnionOfAllTimes) {
  const GltfTimeline line = merge_times({{0.0F, 1.0F, 3.0F}, {0.5F, 1.0F}});
  EXPECT_THAT(line.times_s, ElementsAre(0.0, 0.5, 1.0, 3.0));
  EXPECT_THAT(keys_at(line), ElementsAre(1, 1, 2, 1));
}

TEST(GltfTimeline, IsEmptyWithoutTimes) {
  EXPECT_TRUE(merge_times({}).times_s.empty());
  EXPECT_TRUE(merge_times({{}}).times_s.empty());
}

TEST(GltfTimeline, MergesTimesOfSeveralListsThatAreNearlyTheSame) {
  const float time = 0.3333333F;
  const GltfTimeline line = merge_times({{time}, {std::nextafter(time, 1.0F)}});
  EXPECT_THAT(line.times_s, ElementsAre(double{time}));
  EXPECT_THAT(keys_at(line), ElementsAre(2));
}

TEST(GltfTimeline, PartsTimesOfOneListThatAreNearlyTheSame) {
  // A jump: two keys of one track as close as floats can be.
  const float a = 0.25F, b = std::nextafter(a, 1.0F), c = std::nextafter(b, 1.0F);
  const GltfTimeline line = merge_times({{a, b, c}, {b, 1.0F}});
  ASSERT_EQ(line.times_s.size(), 4U);
  EXPECT_EQ(line.times_s[0], double{a});
  for (std::size_t i = 1; i < 4; ++i) EXPECT_THAT(line.times_s[i] - line.times_s[i - 1], Ge(0.999e-6));
  EXPECT_LT(line.times_s[2] - line.times_s[0], 3e-6);
  // Every key is there, in its list's order.
  std::vector<std::uint32_t> first;
  for (const auto& keys : line.keys) {
    for (const auto& key : keys) {
      if (key.list == 0) first.push_back(key.key);
    }
  }
  EXPECT_THAT(first, ElementsAre(0, 1, 2));
}

TEST(GltfTimeline, KeepsEveryKeyOfManyLists) {
  std::vector<std::vector<float>> lists(7);
  std::size_t total = 0;
  for (std::size_t list = 0; list < lists.size(); ++list) {
    for (int i = 0; i < 200; ++i) lists[list].push_back(static_cast<float>(i) / (23.0F + static_cast<float>(list)));
    total += lists[list].size();
  }
  const GltfTimeline line = merge_times(lists);
  std::size_t found = 0;
  for (std::size_t t = 0; t < line.times_s.size(); ++t) {
    if (t > 0) {
      ASSERT_GT(line.times_s[t], line.times_s[t - 1]);
    }
    for (const auto& key : line.keys[t]) EXPECT_NEAR(line.times_s[t], double{lists[key.list][key.key]}, 1e-6);
    found += line.keys[t].size();
  }
  EXPECT_EQ(found, total);
}

TEST(GltfTracks, BecomeKeyframesThatKeyWhatIsKeyedThen) {
  using animation::Interpolation;
  using animation::Property;
  const std::vector<std::vector<float>> lists{{0.0F, 2.0F}, {1.0F, 2.0F}};
  const GltfTrack turn{{5, Property::Rotation}, Interpolation::Linear, 0, {{0, 0, 0, 1}, {0, 0, 1, 0}}, {}};
  const GltfTrack move{{2, Property::Translation},
                       Interpolation::Cubic,
                       1,
                       {{1, 0, 0, 0}, {2, 0, 0, 0}},
                       {{glm::vec4(3), glm::vec4(4)}, {glm::vec4(5), glm::vec4(6)}}};
  const model::Clip clip = make_clip("walk", {turn, move}, lists);
  EXPECT_EQ(clip.name, "walk");
  EXPECT_EQ(clip.type(), model::ClipType::Skeletal);
  EXPECT_THAT(clip.times_s, ElementsAre(0.0, 1.0, 2.0));
  EXPECT_EQ(clip.duration_s(), 2.0);
  EXPECT_EQ(clip.keyframes[0].pose->values().size(), 1U);
  EXPECT_TRUE(clip.keyframes[0].pose->tangents().empty());
  const model::PoseKey& last = *clip.keyframes[2].pose;
  ASSERT_EQ(last.values().size(), 2U);
  EXPECT_EQ(last.values()[0].channel, move.channel);
  EXPECT_EQ(last.tangents()[0].in, glm::vec4(5));
  EXPECT_EQ(last.tangents()[0].out, glm::vec4(6));
  EXPECT_EQ(last.tangents()[1], model::KeyedTangents{});
  EXPECT_THAT(*clip.channel_modes, ElementsAre(model::ChannelMode{move.channel, Interpolation::Cubic},
                                               model::ChannelMode{turn.channel, Interpolation::Linear}));
}

}  // namespace
}  // namespace tweend::assets
