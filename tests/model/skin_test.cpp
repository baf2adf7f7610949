#include "server/model/skin.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "server/model/morph_targets.hpp"

namespace tweend::model {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<float> kTwoPoints{0, 0, 0, 1, 2, 3};
const std::vector<SkinEntry> kTwoEntries{{0, {}}, {1, {}}};

TEST(Skin, WeightsAreScaledToOneAVertex) {
  const auto skin = Skin::make(kTwoEntries, 4, {0, 1, 0, 0, 1, 0, 0, 0}, {2, 2, 0, 0, 0, 0, 0, 0}, kTwoPoints);
  ASSERT_TRUE(skin) << skin.error().message;
  EXPECT_THAT((*skin)->influences().weights, ElementsAre(0.5F, 0.5F, 0, 0, 1, 0, 0, 0)) << "none at all counts as the first";
}

TEST(Skin, KnowsWhatEachEntryMoves) {
  const auto skin = Skin::make({{0, {}}, {1, {}}, {2, {}}}, 1, {1, 1}, {1, 1}, kTwoPoints);
  ASSERT_TRUE(skin);
  const Bounds& moved = (*skin)->entry_bounds()[1];
  EXPECT_EQ(moved.min, glm::vec3(0, 0, 0));
  EXPECT_EQ(moved.max, glm::vec3(1, 2, 3));
  EXPECT_GT((*skin)->entry_bounds()[2].min.x, (*skin)->entry_bounds()[2].max.x) << "nothing";
}

TEST(Skin, RefusesWhatDoesNotFit) {
  const auto words = [](const Result<SkinPtr>& skin) { return skin ? std::string() : skin.error().message; };
  EXPECT_THAT(words(Skin::make({}, 1, {0, 0}, {1, 1}, kTwoPoints)), HasSubstr("found 0"));
  EXPECT_THAT(words(Skin::make(kTwoEntries, 3, {0, 0, 0, 0, 0, 0}, {1, 1, 1, 1, 1, 1}, kTwoPoints)), HasSubstr("1, 4 or 8"));
  EXPECT_THAT(words(Skin::make(kTwoEntries, 1, {0}, {1, 1}, kTwoPoints)), HasSubstr("found 1 and 2"));
  EXPECT_THAT(words(Skin::make(kTwoEntries, 1, {0, 2}, {1, 1}, kTwoPoints)), HasSubstr("found 2 at vertex 1"));
  EXPECT_THAT(words(Skin::make(kTwoEntries, 1, {0, 1}, {1, -1}, kTwoPoints)), HasSubstr("found -1 at vertex 1"));
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(words(Skin::make(kTwoEntries, 1, {0, 1}, {kNan, 1}, kTwoPoints)), HasSubstr("at vertex 0"));
}

TEST(MorphTargets, AreCheckedAndViewed) {
  const auto made =
      MorphTargets::make({{"smile", 0.25F, 1, {1, 0, 0}, {}, {}}, {"frown", 0, 0, {0, 3, 0, 0, 4, 0}, {}, {}}}, 2);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_THAT((*made)->default_weights(), ElementsAre(0.25F, 0.0F));
  EXPECT_EQ((*made)->views()[0].first_vertex, 1U);
  EXPECT_EQ((*made)->views()[0].vertex_count, 1U);
  EXPECT_EQ((*made)->reach(), 5.0F) << "vertex 1: one metre and four";
}

TEST(MorphTargets, RefuseWhatDoesNotFit) {
  const auto words = [](std::vector<MorphTarget> targets) {
    const auto made = MorphTargets::make(std::move(targets), 2);
    return made ? std::string() : made.error().message;
  };
  EXPECT_THAT(words({{"a", 0, 1, {1, 0, 0, 1, 0, 0}, {}, {}}}), HasSubstr("\"a\""));
  EXPECT_THAT(words({{"a", 0, 0, {1, 0}, {}, {}}}), HasSubstr("\"a\""));
  EXPECT_THAT(words({{"a", 0, 0, {1, 0, 0}, {1, 0, 0, 1, 0, 0}, {}}}), HasSubstr("\"a\""));
  EXPECT_THAT(words({{"a", 0, 0, {}, {}, {}}, {"a", 0, 0, {}, {}, {}}}), HasSubstr("\"a\" again"));
  EXPECT_THAT(words({{"a", 0, 0, {std::numeric_limits<float>::infinity(), 0, 0}, {}, {}}}), HasSubstr("finite"));
}

}  // namespace
}  // namespace tweend::model
