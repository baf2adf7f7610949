#include "clients/cli/stream_tally.hpp"

#include <gtest/gtest.h>

namespace tweend::cli {
namespace {

TEST(StreamTally, KnowsNothingAtFirst) {
  StreamTally tally;
  EXPECT_EQ(tally.rate(), 0.0);
  EXPECT_EQ(tally.median_age_us(), 0);
  tally.add(7, 10, 3000, 1'000'000);
  EXPECT_EQ(tally.rate(), 0.0) << "one packet has no rate";
  EXPECT_EQ(tally.skipped(), 0U) << "what came before we did was not for us";
  EXPECT_EQ(tally.median_age_us(), 3000);
}

TEST(StreamTally, TheRateIsBetweenTheFirstAndTheLast) {
  StreamTally tally;
  for (int i = 0; i < 5; ++i) tally.add(1, 10, 100, 2'000'000 + i * 50'000);
  EXPECT_DOUBLE_EQ(tally.rate(), 20.0);
  EXPECT_EQ(tally.bytes(), 50U);
}

TEST(StreamTally, CountsGapsButNoStepBack) {
  StreamTally tally;
  for (const std::uint32_t sequence : {10U, 11U, 15U, 15U, 3U, 4U}) tally.add(sequence, 0, 0, 0);
  EXPECT_EQ(tally.skipped(), 3U);
}

TEST(StreamTally, CountsOnWhereTheSequenceWraps) {
  StreamTally tally;
  for (const std::uint32_t sequence : {0xFFFFFFFEU, 0U, 1U}) tally.add(sequence, 0, 0, 0);
  EXPECT_EQ(tally.skipped(), 1U);
}

TEST(StreamTally, TakesTheMedianOfTheLatestAges) {
  StreamTally tally;
  for (const int age : {9, 1, 5}) tally.add(0, 0, age, 0);
  EXPECT_EQ(tally.median_age_us(), 5);
  EXPECT_EQ(tally.last_age_us(), 5);
  for (int i = 0; i < 65536; ++i) tally.add(0, 0, 40, 0);
  EXPECT_EQ(tally.median_age_us(), 40);
}

}  // namespace
}  // namespace tweend::cli
