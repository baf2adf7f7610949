#include "server/base/progress_bar.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tweend {
namespace {

Progress halfway() {
  Progress progress;
  progress.done = 10;
  progress.total = 20;
  progress.elapsed_s = 0.5;
  progress.rate = 20.0;
  progress.unit = "fps";
  progress.note = "age 3.1 ms";
  return progress;
}

std::string spaces(std::size_t count) { return std::string(count, ' '); }

TEST(ProgressLine, HasBarFiguresAndTheTimeThatIsLeft) {
  EXPECT_EQ(progress_line(halfway(), 80),
            "[" + std::string(19, '=') + ">" + spaces(19) + "]  10/20  20.0 fps  age 3.1 ms  ETA 0:01");
  EXPECT_EQ(progress_line(halfway(), 80).size(), 80U);
  EXPECT_EQ(progress_line(halfway(), 300).size(), 81U) << "no bar needs to be longer";
}

TEST(ProgressLine, IsNeverWiderThanItMayBe) {
  for (std::size_t width = 0; width < 200; ++width) EXPECT_LE(progress_line(halfway(), width).size(), width);
}

TEST(ProgressLine, GivesUpTheBarThenTheNoteThenItsEnd) {
  EXPECT_EQ(progress_line(halfway(), 40), "10/20  20.0 fps  age 3.1 ms  ETA 0:01");
  EXPECT_EQ(progress_line(halfway(), 30), "10/20  20.0 fps  ETA 0:01");
  EXPECT_EQ(progress_line(halfway(), 8), "10/20  2");
  EXPECT_EQ(progress_line(halfway(), 0), "");
}

TEST(ProgressLine, ShowsThePassedTimeWhereTheTotalIsUnknown) {
  Progress progress = halfway();
  progress.total.reset();
  progress.elapsed_s = 75.0;
  EXPECT_EQ(progress_line(progress, 80), "10  20.0 fps  age 3.1 ms  1:15");
}

TEST(ProgressLine, KnowsNoTimeWithoutARate) {
  Progress progress;
  progress.total = 20;
  EXPECT_EQ(progress_line(progress, 28), "[>         ]  0/20  ETA -:--");
  EXPECT_EQ(progress_line(progress, 20), "0/20  ETA -:--");
}

TEST(ProgressLine, IsFullWhereThereIsNothingToDoOrTooMuchWasDone) {
  Progress progress;
  progress.total = 0;
  EXPECT_EQ(progress_line(progress, 29), "[============]  0/0  ETA 0:00");
  progress.done = 30;
  progress.total = 20;
  EXPECT_EQ(progress_line(progress, 31), "[============]  30/20  ETA 0:00");
}

TEST(DurationText, ReadsLikeAClock) {
  EXPECT_EQ(duration_text(0.0), "0:00");
  EXPECT_EQ(duration_text(59.6), "1:00");
  EXPECT_EQ(duration_text(3725.0), "1:02:05");
  for (const double none : {-1.0, 1e9, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(duration_text(none), "-:--");
  }
}

TEST(ProgressBar, IsDrawnTenTimesASecondAtMost) {
  ProgressBar bar(80);
  EXPECT_NE(bar.draw(halfway(), 5'000'000), "");
  EXPECT_EQ(bar.draw(halfway(), 5'099'999), "");
  EXPECT_NE(bar.draw(halfway(), 5'100'000), "");
}

TEST(ProgressBar, CoversTheLineBeforeAndCleansUp) {
  ProgressBar bar(12);
  Progress progress;
  progress.done = 1000;
  EXPECT_EQ(bar.clear(), "") << "nothing was drawn";
  EXPECT_EQ(bar.draw(progress, 0), "\r1000  0:00");
  progress.done = 1;
  EXPECT_EQ(bar.draw(progress, 100'000), "\r1  0:00   ");
  EXPECT_EQ(bar.clear(), "\r" + spaces(7) + "\r");
  EXPECT_EQ(bar.clear(), "");
}

TEST(ProgressBar, LeavesTheLastColumnFree) {
  ProgressBar narrow(5);
  EXPECT_EQ(narrow.draw(halfway(), 0), "\r10/2");
  ProgressBar none(0);
  EXPECT_EQ(none.draw(halfway(), 0), "\r");
}

}  // namespace
}  // namespace tweend
