#include "server/stage/history.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "tests/support/scenes.hpp"

namespace tweend::stage {
namespace {

History pushed_n(std::size_t n, std::size_t most) {
  History history;
  for (std::size_t i = 0; i < n; ++i) history = history.pushed(std::to_string(i), {}, most);
  return history;
}

TEST(History, IsEmptyAtFirst) {
  EXPECT_TRUE(History{}.empty());
  EXPECT_EQ(History{}.count(), 0U);
}

TEST(History, GivesBackTheNewestStepFirst) {
  History history = pushed_n(3, 10);
  for (const char* method : {"2", "1", "0"}) {
    ASSERT_FALSE(history.empty());
    EXPECT_EQ(history.top().method, method);
    history = history.popped();
  }
  EXPECT_TRUE(history.empty());
}

TEST(History, IsAValue) {
  const History two = pushed_n(2, 10);
  const History three = two.pushed("other", {}, 10);
  const History one = two.popped();
  EXPECT_EQ(two.top().method, "1");
  EXPECT_EQ(three.top().method, "other");
  EXPECT_EQ(one.top().method, "0");
  EXPECT_EQ(three.popped().top().method, "1");
  EXPECT_EQ(three.top().below.get(), &two.top()) << "and shares what it has in common";
}

TEST(History, GivesBackTheLastThousandOfThreeThousand) {
  History history = pushed_n(3000, 1000);
  EXPECT_EQ(history.count(), 1000U);
  for (std::size_t i = 3000; i-- > 2000;) {
    ASSERT_FALSE(history.empty());
    EXPECT_EQ(history.top().method, std::to_string(i));
    history = history.popped();
  }
  EXPECT_TRUE(history.empty());
}

TEST(History, HoldsTheLimitAfterAnyNumberOfPushesAndPops) {
  History history;
  std::vector<std::string> expected;
  std::size_t name = 0;
  for (std::size_t round = 0; round < 200; ++round) {
    for (std::size_t i = 0; i < round % 17; ++i) {
      history = history.pushed(std::to_string(++name), {}, 7);
      expected.push_back(std::to_string(name));
      if (expected.size() > 7) expected.erase(expected.begin());
    }
    for (std::size_t i = 0; i < round % 5 && !expected.empty(); ++i) {
      ASSERT_FALSE(history.empty());
      EXPECT_EQ(history.top().method, expected.back());
      history = history.popped();
      expected.pop_back();
    }
    ASSERT_EQ(history.count(), expected.size());
  }
}

TEST(History, ForgetsTheStepsBeyondTheLimitInTime) {
  const model::ActorPtr actor = test::square_actor("square");
  History history;
  for (int i = 0; i < 3000; ++i) history = history.pushed("actor.remove", {SetActor{"square", actor}}, 10);
  EXPECT_LE(actor.use_count(), 1 + 2 * 10) << "what nobody can take back is not kept";
  history = {};
  EXPECT_EQ(actor.use_count(), 1);
}

TEST(History, KeepsTheChangesOfEachStepThroughItsOwnTidying) {
  History history;
  for (std::size_t i = 0; i < 100; ++i) history = history.pushed("m", {SetActor{std::to_string(i), nullptr}}, 10);
  for (std::size_t i = 100; i-- > 90;) {
    ASSERT_EQ(history.top().changes.size(), 1U);
    EXPECT_EQ(std::get<SetActor>(history.top().changes[0]).actor, std::to_string(i));
    history = history.popped();
  }
}

// The limit is an option: however many steps are let go of, that takes no deep stack. Each step's actor notes where the
// stack is as it goes.
TEST(History, LetsGoOfManyStepsOneAfterTheOther) {
  std::uintptr_t lowest = UINTPTR_MAX;
  std::uintptr_t highest = 0;
  const auto note_depth = [&](const model::Actor* actor) {
    delete actor;
    const auto here = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
    lowest = std::min(lowest, here);
    highest = std::max(highest, here);
  };
  {
    History history;
    for (int i = 0; i < 5000; ++i) {
      history = history.pushed("actor.remove", {SetActor{"square", model::ActorPtr(new model::Actor, note_depth)}}, 10'000);
    }
  }
  ASSERT_NE(highest, 0U);
  EXPECT_LT(highest - lowest, 64U << 10U) << "bytes of stack";
}

TEST(History, OfNoStepsForgetsAtOnce) { EXPECT_TRUE(pushed_n(3, 0).empty()); }

}  // namespace
}  // namespace tweend::stage
