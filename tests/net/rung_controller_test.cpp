#include "server/net/rung_controller.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace tweend::net {
namespace {

constexpr std::int64_t kSecond = 1'000'000;
constexpr std::size_t kRungCount = 7;

/// Bytes of a picture on each rung: two thirds of the one above.
double picture_bytes(std::size_t rung) { return 90'000.0 * std::pow(2.0 / 3.0, static_cast<double>(rung)); }

/// A reader behind a link of so many bytes a second that takes one packet after the other; of those that come meanwhile the
/// newest waits. Another rung's packets come a while after they were asked for.
class Link {
 public:
  explicit Link(double takes_per_s) : bytes_per_s(takes_per_s) {}

  double bytes_per_s;
  double packets_per_s = 30.0;
  std::int64_t switch_us = 50'000;

  struct Move {
    std::int64_t us;
    std::size_t rung;
  };
  std::vector<Move> moves;
  std::vector<std::int64_t> ages_us;  ///< of each packet when its last byte was written
  RungController controller{kRungCount};

  [[nodiscard]] std::size_t rung() const { return controller.rung(); }

  void run(std::int64_t duration_us) {
    const std::int64_t end = now_us_ + duration_us;
    while (now_us_ < end) {
      const auto period = static_cast<std::int64_t>(1e6 / packets_per_s);
      const std::int64_t next_packet = last_packet_us_ + period;
      if (writing_ && writing_->done_us <= next_packet) {
        now_us_ = std::max(now_us_, writing_->done_us);
        finish();
      } else {
        now_us_ = next_packet;
        produce();
      }
      note_move();
    }
  }

 private:
  struct Packet {
    std::size_t rung;
    std::int64_t offered_us;
    std::int64_t done_us = 0;
  };

  void produce() {
    last_packet_us_ = now_us_;
    if (asked_ && now_us_ >= asked_->us + switch_us) {
      produced_rung_ = asked_->rung;
      asked_.reset();
      controller.settle();
    }
    if (waiting_) controller.replaced(now_us_);
    waiting_ = Packet{produced_rung_, now_us_};
    if (!writing_) start();
  }
  void finish() {
    ages_us.push_back(now_us_ - writing_->offered_us);
    if (writing_->rung == produced_rung_) controller.written(now_us_, now_us_ - writing_->offered_us);
    writing_.reset();
    if (waiting_) start();
  }
  void start() {
    writing_ = waiting_;
    writing_->done_us = now_us_ + static_cast<std::int64_t>(1e6 * picture_bytes(writing_->rung) / bytes_per_s);
    waiting_.reset();
  }
  void note_move() {
    if (controller.rung() == (moves.empty() ? 0 : moves.back().rung)) return;
    moves.push_back({now_us_, controller.rung()});
    asked_ = moves.back();
  }

  std::int64_t now_us_ = 0;
  std::int64_t last_packet_us_ = 0;
  std::size_t produced_rung_ = 0;
  std::optional<Packet> writing_, waiting_;
  std::optional<Move> asked_;
};

/// The first rung of whose packets the link takes at least thirteen of sixteen.
std::size_t fitting_rung(double bytes_per_s, double packets_per_s) {
  std::size_t rung = 0;
  while (rung + 1 < kRungCount && picture_bytes(rung) * packets_per_s * 13 / 16 > bytes_per_s) ++rung;
  return rung;
}

TEST(RungController, StaysAtTheTopWhereTheLinkTakesAll) {
  Link link(90'000.0 * 30 * 1.1);
  link.run(120 * kSecond);
  EXPECT_TRUE(link.moves.empty());
}

TEST(RungController, ConvergesOnTheRungThatTheLinkTakes) {
  for (const double bytes_per_s : {200e3, 250e3, 400e3, 700e3, 1.1e6, 1.9e6}) {
    Link link(bytes_per_s);
    link.run(4 * kSecond);
    const std::size_t fits = fitting_rung(bytes_per_s, 30);
    EXPECT_NEAR(static_cast<double>(link.rung()), static_cast<double>(fits), 1.0) << bytes_per_s;
    // In the long run it is there but for the tries of the rung above, which become rare.
    link.run(300 * kSecond);
    std::int64_t beside_us = 0;
    for (std::size_t i = 0; i < link.moves.size(); ++i) {
      const std::int64_t until = i + 1 < link.moves.size() ? link.moves[i + 1].us : 304 * kSecond;
      if (link.moves[i].rung < fits || link.moves[i].rung > fits + 1) beside_us += until - link.moves[i].us;
    }
    EXPECT_LT(beside_us, 15 * kSecond) << bytes_per_s;
  }
}

TEST(RungController, GoesDownWithinSecondsAndThenShowsWhatIsNew) {
  Link link(250e3);  // 2 Mbit/s
  link.run(5 * kSecond / 2);
  EXPECT_GE(link.rung(), 5U);
  link.ages_us.clear();
  link.run(60 * kSecond);
  std::sort(link.ages_us.begin(), link.ages_us.end());
  EXPECT_LT(link.ages_us[link.ages_us.size() / 2], 100'000);
  EXPECT_LT(link.ages_us[link.ages_us.size() * 99 / 100], 250'000);
}

TEST(RungController, TriesTheRungAboveEverMoreSeldom) {
  Link link(picture_bytes(3) * 30 * 1.05);
  link.run(600 * kSecond);
  std::vector<std::int64_t> tries;
  for (std::size_t i = 1; i < link.moves.size(); ++i) {
    if (link.moves[i].rung < link.moves[i - 1].rung) tries.push_back(link.moves[i].us);
  }
  ASSERT_GE(tries.size(), 8U);
  EXPECT_LE(tries.size(), 20U);
  for (std::size_t i = 1; i < tries.size(); ++i) EXPECT_GE(tries[i] - tries[i - 1], RungController::kCalmUs);
  EXPECT_GE(tries.back() - tries[tries.size() - 2], RungController::kLongestCalmUs);
}

TEST(RungController, ComesBackWhenTheLinkDoes) {
  Link link(250e3);
  link.run(20 * kSecond);
  ASSERT_GE(link.rung(), 4U);
  link.bytes_per_s = 10e6;
  // At worst the wait of the last failed try is over, then two seconds a rung.
  link.run(60 * kSecond);
  EXPECT_EQ(link.rung(), 0U);
  const std::size_t moves = link.moves.size();
  link.run(60 * kSecond);
  EXPECT_EQ(link.moves.size(), moves);
}

TEST(RungController, RecoversFromAMinutesWaitStepByStep) {
  Link link(picture_bytes(3) * 30 * 1.05);
  link.run(400 * kSecond);  // the wait has grown to its longest
  link.bytes_per_s = 10e6;
  link.run(100 * kSecond);
  EXPECT_EQ(link.rung(), 0U);
}

TEST(RungController, ARungIsNotJudgedByWhatTheOneAboveHasLeft) {
  Link link(250e3);
  link.switch_us = 700'000;  // packets of the rung above go on for long
  link.run(2 * kSecond);
  EXPECT_LE(link.moves.size(), 3U) << "one move at a time: at most one every 0.7 s";
}

TEST(RungController, AStallCostsOneRung) {
  Link link(10e6);
  link.run(5 * kSecond);
  link.bytes_per_s = 1e3;  // one packet gets stuck
  link.run(kSecond / 2);
  EXPECT_LE(link.rung(), 1U);
}

TEST(RungController, SlowPicturesThatNothingReplacesAreJudgedByTheirAge) {
  Link link(200e3);
  link.packets_per_s = 1;  // 0.45 s each: in time for the next, but old
  link.run(60 * kSecond);
  EXPECT_GE(link.rung(), 1U);
  EXPECT_LE(link.rung(), 3U) << "0.13 s";
}

// A picture now and then: time passes in which nothing is measured.
TEST(RungController, ClimbsByWhatWasMeasuredOnly) {
  RungController controller(kRungCount);
  std::int64_t now_us = 0;
  controller.written(now_us, 0);
  while (controller.rung() == 0) controller.replaced(now_us += 33'000);
  controller.settle();
  controller.written(now_us, 0);
  for (int i = 1; i < RungController::kJudgedPackets; ++i) {
    controller.written(now_us += 10 * kSecond, 1000);
    ASSERT_EQ(controller.rung(), 1U) << i;
  }
  controller.written(now_us += 10 * kSecond, 1000);
  EXPECT_EQ(controller.rung(), 0U);
}

TEST(RungController, SinglePressedPacketsAreNoPressure) {
  RungController controller(kRungCount);
  std::int64_t now_us = 0;
  controller.written(now_us, 0);
  for (int i = 0; i < 1000; ++i) {
    now_us += 33'000;
    if (i % 16 == 0 || i % 16 == 5) {
      controller.replaced(now_us);
    } else {
      controller.written(now_us, 1000);
    }
    ASSERT_EQ(controller.rung(), 0U) << i;
  }
}

TEST(RungController, StaysOnTheLowestRung) {
  RungController controller(2);
  std::int64_t now_us = 0;
  controller.written(now_us, 0);
  for (int i = 0; i < 100; ++i) controller.replaced(now_us += 33'000);
  EXPECT_EQ(controller.rung(), 1U);
  controller.settle();
  controller.written(now_us, 0);
  for (int i = 0; i < 100; ++i) controller.replaced(now_us += 33'000);
  EXPECT_EQ(controller.rung(), 1U);
  RungController only(1);
  only.written(0, 0);
  for (int i = 1; i < 100; ++i) only.replaced(i * 33'000);
  EXPECT_EQ(only.rung(), 0U);
}

// A move that leads nowhere (the stream was closed, say) does not end the judging for good.
TEST(RungController, GoesOnWhereAMoveIsNotHeard) {
  RungController controller(kRungCount);
  std::int64_t now_us = 0;
  controller.written(now_us, 0);
  while (controller.rung() == 0) controller.replaced(now_us += 33'000);
  while (controller.rung() == 1 && now_us < 20 * kSecond) controller.written(now_us += 33'000, 1000);
  EXPECT_EQ(controller.rung(), 0U);
}

}  // namespace
}  // namespace tweend::net
