#include "server/model/skeleton.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace tweend::model {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Joint joint(std::string name, std::int32_t parent, float x = 0.0F) {
  Joint j{std::move(name), parent, {}};
  j.rest.translation.x = x;
  return j;
}

TEST(Skeleton, EvaluatesLevelByLevelAndKeepsTheGivenOrder) {
  const auto made = Skeleton::make({joint("hand", 1, 3), joint("arm", 2, 2), joint("root", -1, 1), joint("tail", -1, 4)});
  ASSERT_TRUE(made) << made.error().message;
  const Skeleton& s = **made;
  EXPECT_EQ(s.joints()[0].name, "hand");
  EXPECT_EQ(s.joint_at(0), 2U);
  EXPECT_EQ(s.joint_at(1), 3U);
  EXPECT_EQ(s.joint_at(2), 1U);
  EXPECT_EQ(s.joint_at(3), 0U);
  EXPECT_THAT(s.parent_places(), ElementsAre(-1, -1, 0, 2));
  EXPECT_EQ(s.rest().joint(s.place_of(0)).translation.x, 3.0F);
  EXPECT_EQ(s.find("tail"), 3U);
  EXPECT_EQ(s.find("head"), std::nullopt);
}

TEST(Skeleton, ParentsAlwaysComeFirst) {
  std::mt19937 rng(3);
  for (int round = 0; round < 200; ++round) {
    const auto count = static_cast<std::int32_t>(1 + rng() % 60);
    std::vector<std::int32_t> order(static_cast<std::size_t>(count));
    for (std::int32_t i = 0; i < count; ++i) order[static_cast<std::size_t>(i)] = i;
    std::shuffle(order.begin(), order.end(), rng);  // joint order[i] may hang on any order[k], k < i
    std::vector<Joint> joints(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const std::int32_t parent = i == 0 || rng() % 8 == 0 ? -1 : order[rng() % i];
      joints[static_cast<std::size_t>(order[i])] = joint("j" + std::to_string(order[i]), parent);
    }
    const SkeletonPtr s = *Skeleton::make(joints);
    for (std::uint32_t place = 0; place < s->size(); ++place) {
      const std::uint32_t at = s->joint_at(place);
      EXPECT_EQ(s->place_of(at), place);
      const std::int32_t parent = s->joints()[at].parent;
      const std::int32_t parent_place =
          parent < 0 ? -1 : static_cast<std::int32_t>(s->place_of(static_cast<std::uint32_t>(parent)));
      EXPECT_EQ(s->parent_places()[place], parent_place);
      EXPECT_LT(parent_place, static_cast<std::int32_t>(place));
    }
  }
}

void expect_refused(std::vector<Joint> joints, const std::string& path, const std::string& words) {
  const auto made = Skeleton::make(std::move(joints));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::InvalidParams);
  EXPECT_EQ(made.error().path, path);
  EXPECT_THAT(made.error().message, HasSubstr(words));
}

TEST(Skeleton, RefusesWhatIsNoTree) {
  expect_refused({}, "joints", "at least one joint");
  expect_refused({joint("a", -1), joint("a", 0)}, "joints[1].name", "\"a\" again");
  expect_refused({joint("", -1)}, "joints[0].name", "empty");
  expect_refused({joint("a", 1)}, "joints[0].parent", "found 1");
  expect_refused({joint("a", -2)}, "joints[0].parent", "found -2");
  expect_refused({joint("a", 0)}, "joints[0].parent", "above itself");
  expect_refused({joint("root", -1), joint("a", 3), joint("b", 1), joint("c", 2)}, "joints[1].parent", "above itself");
}

TEST(Skeleton, ItsHashFollowsWhatItIs) {
  const auto hash = [](std::vector<Joint> joints) { return (*Skeleton::make(std::move(joints)))->hash(); };
  const ContentHash first = hash({joint("a", -1), joint("b", 0)});
  EXPECT_EQ(first, hash({joint("a", -1), joint("b", 0)}));
  EXPECT_NE(first, hash({joint("a", -1), joint("c", 0)}));
  EXPECT_NE(first, hash({joint("a", -1), joint("b", -1)}));
  EXPECT_NE(first, hash({joint("a", -1), joint("b", 0, 0.5F)}));
}

}  // namespace
}  // namespace tweend::model
