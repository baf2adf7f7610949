#include "server/model/pose_key.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tweend::model {
namespace {

using animation::Channel;
using animation::Property;

const Channel kMove{1, Property::Translation};
const Channel kTurn{1, Property::Rotation};
const Channel kWeight{0, Property::Weight};

TEST(PoseKey, FindsWhatItKeysWhateverTheOrderItWasGivenIn) {
  const PoseKey key({{kTurn, {0, 0, 0, 1}}, {kMove, {1, 2, 3, 0}}, {kWeight, {0.5F, 0, 0, 0}}},
                    {{{1, 0, 0, 0}, {}}, {{2, 0, 0, 0}, {}}, {{3, 0, 0, 0}, {}}});
  ASSERT_EQ(key.values().size(), 3U);
  EXPECT_TRUE(key.values()[0].channel == kWeight && key.values()[1].channel == kMove && key.values()[2].channel == kTurn);
  EXPECT_EQ(key.tangents()[0].in.x, 3.0F);
  EXPECT_EQ(key.tangents()[1].in.x, 2.0F);
  EXPECT_EQ(key.tangents()[2].in.x, 1.0F);
  ASSERT_NE(key.find(kMove), nullptr);
  EXPECT_EQ(key.find(kMove)->value.y, 2.0F);
  EXPECT_EQ(key.find({0, Property::Rotation}), nullptr);
  EXPECT_EQ(key.find({2, Property::Translation}), nullptr);
}

TEST(PoseKey, IsNamedByItsContent) {
  const auto hash = [](std::vector<KeyedValue> values, std::vector<KeyedTangents> tangents = {}) {
    return PoseKey(std::move(values), std::move(tangents)).hash();
  };
  const ContentHash first = hash({{kMove, {1, 2, 3, 0}}, {kTurn, {0, 0, 0, 1}}});
  EXPECT_EQ(first, hash({{kTurn, {0, 0, 0, 1}}, {kMove, {1, 2, 3, 0}}}));
  EXPECT_NE(first, hash({{kMove, {1, 2, 3.5F, 0}}, {kTurn, {0, 0, 0, 1}}}));
  EXPECT_NE(first, hash({{{2, Property::Translation}, {1, 2, 3, 0}}, {kTurn, {0, 0, 0, 1}}}));
  EXPECT_NE(first, hash({{kMove, {1, 2, 3, 0}}, {kTurn, {0, 0, 0, 1}}}, {{}, {}}));
}

}  // namespace
}  // namespace tweend::model
