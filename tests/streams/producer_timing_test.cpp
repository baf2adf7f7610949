#include <gtest/gtest.h>

#include <cstdint>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include "server/streams/producer.hpp"
#include "tests/streams/streaming.hpp"

// What a producer does when the strand or the workers are busy elsewhere. Time is let pass by holding a thread until the
// clock reads a certain value; nothing depends on how much later it is let go.

namespace tweend::streams {
namespace {

using stage::Player;
using stage::PlayRange;
using test::scene_of;
using test::square_actor;
using test::Streaming;

constexpr std::uint32_t kStream = 7;

void wait_until_clock_reads(ClockUs at_us) {
  while (steady_now_us() < at_us) std::this_thread::yield();
}

// The tick of a reading may come late, after a seek at a later reading: time before the seek is not the new playhead's.
TEST(ProducerTiming, NeverShowsAPlayheadAtAReadingBeforeItWasSet) {
  Streaming s({scene_of("main", {square_actor("square", {{.keys = 2, .spacing_s = 1000.0}})})});
  const StreamKey key = test::vertices_of("main", "square", 5.0);
  constexpr ClockUs kPeriodUs = 200'000;
  s.stage.act([](Player& player, const PlayRange& range, ClockUs now_us) {
    player.seek(range, 400.0, now_us);
    player.play(range, now_us);
  });
  s.subscribe(key, kStream);
  const ClockUs last_us = s.sink->wait_for(kStream, 2)[1]->header.server_us;  // on the grid
  // The strand is held until the next reading of the grid is past; the seek is carried out before its tick.
  s.stage->post([last_us] { wait_until_clock_reads(last_us + kPeriodUs + 2'000); });
  const ClockUs sought_us =
      s.stage.act([](Player& player, const PlayRange& range, ClockUs now_us) { player.seek(range, 0.0, now_us); }).now_us;
  const auto packets =
      s.sink->wait_until(kStream, [](const Packet& p) { return (p.header.flags & protocol::kFlagDiscontinuity) != 0; });
  const protocol::PacketHeader& first = packets.back()->header;
  EXPECT_GE(first.server_us, sought_us);
  EXPECT_LT(first.media_us, 500'000'000) << "wrapped backwards from the start to the end";
  EXPECT_NEAR(static_cast<double>(first.media_us), static_cast<double>(first.server_us - sought_us), 2.0);
}

/// Holds the only worker of some until it is let go.
class BusyWorker {
 public:
  explicit BusyWorker(WorkerPool& workers) {
    std::promise<void> started;
    workers.post([&started, gone = go_.get_future().share()] {
      started.set_value();
      gone.wait();
    });
    started.get_future().wait();
  }
  void let_go() { go_.set_value(); }

 private:
  std::promise<void> go_;
};

TEST(ProducerTiming, MissesReadingsWhileAnEvaluationIsUnderWayAndQueuesNone) {
  Streaming s({scene_of("main", {square_actor("square", {{.keys = 2, .spacing_s = 1000.0}})})}, 1);
  s.stage.act(&Player::play);
  const StreamKey key = test::vertices_of("main", "square", 200.0);
  constexpr ClockUs kPeriodUs = 5'000;
  s.subscribe(key, kStream);
  s.sink->wait_for(kStream, 3);
  auto busy = std::make_unique<BusyWorker>(s.workers);
  const ClockUs from_us = steady_now_us();
  wait_until_clock_reads(from_us + 10 * kPeriodUs);
  const ClockUs until_us = steady_now_us();
  busy->let_go();
  const auto packets =
      s.sink->wait_until(kStream, [&](const Packet& p) { return p.header.server_us > until_us + 3 * kPeriodUs; });
  std::size_t meanwhile = 0;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    EXPECT_EQ(packets[i]->header.sequence, i) << "what was missed was not produced, and does not count";
    const ClockUs at_us = packets[i]->header.server_us;
    if (at_us > from_us + kPeriodUs && at_us < until_us - kPeriodUs) ++meanwhile;
  }
  EXPECT_LE(meanwhile, 1U) << "one in flight";
  s.settle();
}

TEST(ProducerTiming, CountsTheReadingsItMissed) {
  Streaming s({scene_of("main", {square_actor("square", {{.keys = 2, .spacing_s = 1000.0}})})}, 1);
  s.stage.act(&Player::play);
  s.subscribe(test::vertices_of("main", "square", 200.0), kStream);
  s.sink->wait_for(kStream, 3);
  const std::int64_t before = s.stage.metrics.ticks_missed_total.load();
  auto busy = std::make_unique<BusyWorker>(s.workers);
  wait_until_clock_reads(steady_now_us() + 60'000);
  s.settle();  // what was made before has come
  const std::size_t count = s.sink->packets(kStream).size();
  busy->let_go();
  s.sink->wait_for(kStream, count + 3);
  EXPECT_GE(s.stage.metrics.ticks_missed_total.load(), before + 8) << "of some twelve, while the one before was at work";
}

// What the thread of the sinks does not take waits in memory that nothing else bounds.
TEST(ProducerTiming, MissesReadingsWhileTheSinksTakeNothing) {
  Streaming s({scene_of("main", {square_actor("square", {{.keys = 2, .spacing_s = 1000.0}})})});
  s.stage.act(&Player::play);
  s.subscribe(test::vertices_of("main", "square", 240.0), kStream);
  s.sink->wait_for(kStream, 3);
  auto busy = std::make_unique<BusyWorker>(s.delivery);
  const std::size_t before = s.sink->packets(kStream).size();
  const Metrics& metrics = s.stage.metrics;
  const std::int64_t produced = metrics.packets_produced_total.load(), missed = metrics.ticks_missed_total.load();
  while (metrics.ticks_missed_total.load() < missed + 30) std::this_thread::yield();
  EXPECT_LE(metrics.packets_produced_total.load(), produced + 10) << "eight wait, and one or two were in the making";
  busy->let_go();
  const auto packets = s.sink->wait_for(kStream, before + 20);
  for (std::size_t i = 0; i < packets.size(); ++i) {
    EXPECT_EQ(packets[i]->header.sequence, i) << "what was missed was not produced, and does not count";
  }
}

// A change after a pause is shown at once: not while the sinks take nothing, or it would be tried again and again.
TEST(ProducerTiming, WaitsForTheNextReadingEachTimeTheSinksTakeNothing) {
  Streaming s({scene_of("main", {square_actor("square")})});
  constexpr double kRate = 50.0;
  s.subscribe(test::vertices_of("main", "square", kRate), kStream);
  s.sink->wait_for(kStream, 1);
  auto busy = std::make_unique<BusyWorker>(s.delivery);
  const std::int64_t before = s.stage.metrics.ticks_missed_total.load();
  const ClockUs from_us = steady_now_us();
  for (int i = 1; s.stage.metrics.ticks_missed_total.load() < before + 3; ++i) {
    s.stage.act([i](Player& player, const PlayRange& range, ClockUs now_us) { player.seek(range, 0.001 * i, now_us); });
  }
  const std::int64_t missed =
      s.stage.metrics.ticks_missed_total.load() - before;  // it goes on by itself: counted before the clock
  const double readings = static_cast<double>(steady_now_us() - from_us) * kRate / 1e6;
  EXPECT_LE(static_cast<double>(missed), readings + 2.0);
  busy->let_go();
  s.stage.act([](Player& player, const PlayRange& range, ClockUs now_us) { player.seek(range, 2.0, now_us); });
  s.sink->wait_until(kStream, [](const Packet& p) { return p.header.media_us == 2'000'000; });
}

TEST(ProducerTiming, ShowsTheNewestStateAfterABusyWorker) {
  Streaming s({scene_of("main", {square_actor("square")})}, 1);
  const StreamKey key = test::vertices_of("main", "square", 200.0);
  s.subscribe(key, kStream);
  s.sink->wait_for(kStream, 1);
  auto busy = std::make_unique<BusyWorker>(s.workers);
  for (const double time_s : {0.5, 1.0, 1.5}) {
    s.stage.act([time_s](Player& player, const PlayRange& range, ClockUs now_us) { player.seek(range, time_s, now_us); });
  }
  busy->let_go();
  const auto packets = s.sink->wait_until(kStream, [](const Packet& p) { return p.header.media_us == 1'500'000; });
  EXPECT_LE(packets.size(), 4U);
  EXPECT_EQ(packets.back()->header.flags, protocol::kFlagKey | protocol::kFlagDiscontinuity | protocol::kFlagLast);
}

TEST(ProducerTiming, SendsTheFirstPacketAtOnceAtAnyRate) {
  Streaming s({scene_of("main", {square_actor("square"), square_actor("witness", {{.spacing_s = 1000.0}})})}, 1);
  s.stage.act(&Player::play, "witness");
  std::uint32_t stream = 1;
  for (const double rate : {1e-3, 1e-9, 1e-12}) s.subscribe(test::vertices_of("main", "square", rate), stream++);
  s.let_pass(test::vertices_of("main", "witness", 240.0), 12);  // one worker, one queue: those before have had their turn
  for (stream = 1; stream <= 3; ++stream) EXPECT_EQ(s.sink->packets(stream).size(), 1U) << "stream " << stream;
}

// Rates are positive numbers up to 240: the slowest has a period that no clock can hold.
TEST(ProducerTiming, AVanishingRateIsSlowAndNotFast) {
  Streaming s(
      {scene_of("main", {square_actor("square", {{.spacing_s = 1000.0}}), square_actor("witness", {{.spacing_s = 1000.0}})})},
      1);
  s.stage.act(&Player::play);
  s.subscribe(test::vertices_of("main", "square", 1e-300), kStream);
  s.let_pass(test::vertices_of("main", "witness", 240.0), 12);
  EXPECT_LE(s.sink->packets(kStream).size(), 1U);
}

}  // namespace
}  // namespace tweend::streams
