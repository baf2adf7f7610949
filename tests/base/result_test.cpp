#include "server/base/result.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "server/base/clock.hpp"

namespace tweend {
namespace {

Status positive(int n) {
  if (n <= 0) return fail(ErrorCode::InvalidParams, "expected more than 0", "params.n");
  return {};
}

Result<std::unique_ptr<int>> boxed(int n) {
  TWEEND_TRY(positive(n));
  return std::make_unique<int>(n);
}

Result<int> sum(int a, int b, int& reached) {
  TWEEND_ASSIGN(const auto first, boxed(a));
  reached = 1;
  TWEEND_ASSIGN(const auto second, boxed(b));
  reached = 2;
  return *first + *second;
}

TEST(Result, CarriesAMoveOnlyValueThroughAssign) {
  int reached = 0;
  const Result<int> result = sum(3, 4, reached);
  ASSERT_TRUE(result);
  EXPECT_EQ(*result, 7);
}

TEST(Result, LeavesAtTheFirstErrorAndKeepsItWhole) {
  int reached = 0;
  const Result<int> result = sum(3, 0, reached);
  ASSERT_FALSE(result);
  EXPECT_EQ(reached, 1);
  EXPECT_EQ(result.error(), (Error{ErrorCode::InvalidParams, "expected more than 0", "params.n", {}}));
}

TEST(Clock, CountsSecondsBetweenReadingsWithSign) {
  EXPECT_DOUBLE_EQ(seconds_between(1'000'000, 3'500'000), 2.5);
  EXPECT_DOUBLE_EQ(seconds_between(3'500'000, 1'000'000), -2.5);
}

TEST(Clock, NamesTheInstantOfAReading) {
  const ClockUs before_us = steady_now_us();
  const SteadyClock::time_point now = SteadyClock::now();
  const ClockUs after_us = steady_now_us();
  EXPECT_LE(instant(before_us), now);
  EXPECT_LE(now, instant(after_us + 1));  // readings are cut to whole microseconds
}

}  // namespace
}  // namespace tweend
