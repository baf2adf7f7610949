#include "server/streams/mailbox.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/allocations.hpp"

namespace tweend::streams {
namespace {

using test::allocations;

/// Notes what it is given and when it is flushed, without taking memory for it.
class NotingSink final : public PacketSink {
 public:
  NotingSink() { sequences.reserve(100'000); }
  void offer(std::uint32_t, const PacketPtr& packet) override { sequences.push_back(packet->header.sequence); }
  void flush() override {
    ++flushes;
    offered_at_flush = sequences.size();
  }
  void ended(std::uint32_t, const std::string&) override {}
  std::vector<std::uint32_t> sequences;
  std::size_t flushes = 0;
  std::size_t offered_at_flush = 0;
};

struct Letters {
  PacketPtr packet(std::uint32_t sequence) const {
    const auto made = pool->take();
    made->header.sequence = sequence;
    return made;
  }
  std::shared_ptr<PacketPool> pool = std::make_shared<PacketPool>();
  std::shared_ptr<NotingSink> sink = std::make_shared<NotingSink>();
  std::shared_ptr<const Subscriptions> to = std::make_shared<const Subscriptions>(Subscriptions{{sink, 1}});
};

TEST(Mailbox, HandsOverOnlyOnTheOtherThread) {
  Metrics metrics;
  std::vector<Task> posted;
  Mailbox mailbox([&](Task task) { posted.push_back(std::move(task)); }, metrics);
  const Letters letters;
  mailbox.put({letters.packet(1), letters.to});
  EXPECT_TRUE(letters.sink->sequences.empty());
  ASSERT_EQ(posted.size(), 1U);
  posted[0]();
  EXPECT_EQ(letters.sink->sequences, (std::vector<std::uint32_t>{1}));
}

TEST(Mailbox, WakesTheOtherThreadOnceForAllThatWait) {
  Metrics metrics;
  std::vector<Task> posted;
  Mailbox mailbox([&](Task task) { posted.push_back(std::move(task)); }, metrics);
  const Letters letters;
  for (std::uint32_t i = 0; i < 5; ++i) mailbox.put({letters.packet(i), letters.to});
  ASSERT_EQ(posted.size(), 1U);
  posted[0]();
  EXPECT_EQ(letters.sink->sequences.size(), 5U);
  mailbox.put({letters.packet(5), letters.to});
  ASSERT_EQ(posted.size(), 2U) << "and again for what comes later";
  posted[1]();
  EXPECT_EQ(letters.sink->sequences.size(), 6U);
}

TEST(Mailbox, KeepsCallsInTheirPlaceBetweenPackets) {
  Metrics metrics;
  std::vector<Task> posted;
  Mailbox mailbox([&](Task task) { posted.push_back(std::move(task)); }, metrics);
  const Letters letters;
  mailbox.put({letters.packet(1), letters.to});
  mailbox.call([&] { letters.sink->sequences.push_back(1000); });
  mailbox.put({letters.packet(2), letters.to});
  posted[0]();
  EXPECT_EQ(letters.sink->sequences, (std::vector<std::uint32_t>{1, 1000, 2}));
}

TEST(Mailbox, TakesMoreWhileItIsEmptied) {
  Metrics metrics;
  std::vector<Task> posted;
  Mailbox mailbox([&](Task task) { posted.push_back(std::move(task)); }, metrics);
  const Letters letters;
  mailbox.call([&] { mailbox.put({letters.packet(1), letters.to}); });
  posted[0]();
  ASSERT_EQ(posted.size(), 2U);
  posted[1]();
  EXPECT_EQ(letters.sink->sequences, (std::vector<std::uint32_t>{1}));
}

TEST(Mailbox, FlushesEachSinkOnceAfterAllThatItIsOffered) {
  Metrics metrics;
  Task waiting;
  Mailbox mailbox([&](Task task) { waiting = std::move(task); }, metrics);
  const Letters letters;
  const auto other = std::make_shared<NotingSink>();
  const auto both = std::make_shared<const Subscriptions>(Subscriptions{{other, 1}, {letters.sink, 2}});
  for (std::uint32_t i = 0; i < 3; ++i) mailbox.put({letters.packet(i), both});
  waiting();  // one list: sink by sink
  EXPECT_EQ(letters.sink->flushes, 1U);
  EXPECT_EQ(letters.sink->offered_at_flush, 3U);
  EXPECT_EQ(other->flushes, 1U);
  EXPECT_EQ(other->offered_at_flush, 3U);
  mailbox.put({letters.packet(3), letters.to});
  mailbox.put({letters.packet(4), both});
  mailbox.call([] {});
  mailbox.put({letters.packet(5), both});
  mailbox.put({letters.packet(6), letters.to});
  waiting();  // several: a sink of more than one is still flushed once
  EXPECT_EQ(letters.sink->flushes, 2U);
  EXPECT_EQ(letters.sink->offered_at_flush, 7U);
  EXPECT_EQ(other->flushes, 2U);
  EXPECT_EQ(other->offered_at_flush, 5U);
}

TEST(Mailbox, PassesOverSinksThatAreGone) {
  Metrics metrics;
  std::vector<Task> posted;
  Mailbox mailbox([&](Task task) { posted.push_back(std::move(task)); }, metrics);
  const Letters letters;
  auto gone = std::make_shared<NotingSink>();
  const auto to = std::make_shared<const Subscriptions>(Subscriptions{{gone, 1}, {letters.sink, 2}});
  mailbox.put({letters.packet(1), to});
  gone.reset();
  posted[0]();
  EXPECT_EQ(letters.sink->sequences.size(), 1U);
}

TEST(Mailbox, LetsGoOfPacketsThatWereHandedOver) {
  Metrics metrics;
  std::vector<Task> posted;
  Mailbox mailbox([&](Task task) { posted.push_back(std::move(task)); }, metrics);
  const Letters letters;
  PacketPtr packet = letters.packet(1);
  const Packet* const address = packet.get();
  mailbox.put({packet, letters.to});
  posted[0]();
  packet.reset();
  EXPECT_EQ(letters.pool->take().get(), address) << "it has come home";
}

TEST(Mailbox, MeasuresHowLatePacketsAreAsTheyAreHandedOver) {
  Metrics metrics;
  Task waiting;
  Mailbox mailbox([&](Task task) { waiting = std::move(task); }, metrics);
  const Letters letters;
  const auto delays = [&] { return metrics.packet_delay_seconds.read(); };
  const auto put = [&](ClockUs before_us, bool again = false) {
    const auto packet = letters.pool->take();
    packet->header.server_us = steady_now_us() - before_us;
    mailbox.put({packet, letters.to, again});
  };
  put(2'000'000);
  EXPECT_EQ(delays().count, 0) << "it waits, and grows later";
  waiting();
  EXPECT_EQ(delays().count, 1);
  const std::int64_t first_us = delays().sum_us;
  EXPECT_GE(first_us, 2'000'000);
  EXPECT_EQ(metrics.packet_jitter_seconds.read().count, 0) << "there was none before it";
  put(60'000'000, true);  // for who came later
  waiting();
  EXPECT_EQ(delays().count, 1);
  put(5'000'000);
  waiting();
  EXPECT_EQ(delays().count, 2);
  EXPECT_EQ(metrics.packet_jitter_seconds.read().count, 1);
  const std::int64_t second_us = delays().sum_us - first_us;
  EXPECT_GE(second_us, 5'000'000);
  EXPECT_EQ(metrics.packet_jitter_seconds.read().sum_us, std::abs(second_us - first_us));
}

TEST(Mailbox, TellsHowOftenItWasEmptied) {
  Metrics metrics;
  Task waiting;
  Mailbox mailbox([&](Task task) { waiting = std::move(task); }, metrics);
  const Letters letters;
  for (std::uint64_t i = 0; i < 3; ++i) {
    mailbox.put({letters.packet(1), letters.to});
    mailbox.put({letters.packet(2), letters.to});
    EXPECT_EQ(mailbox.drains(), i);
    waiting();
  }
  EXPECT_EQ(mailbox.drains(), 3U);
}

TEST(Mailbox, TakesNoMemoryForAPacketOnceItHasGrown) {
  Metrics metrics;
  Task waiting;
  Mailbox mailbox([&](Task task) { waiting = std::move(task); }, metrics);
  const Letters letters;
  const auto run = [&](std::uint32_t rounds) {
    for (std::uint32_t i = 0; i < rounds; ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) mailbox.put({letters.packet(i), letters.to});
      waiting();
    }
  };
  run(10);
  const std::size_t before = allocations();
  run(1000);
  EXPECT_EQ(allocations(), before);
}

TEST(Mailbox, KeepsTheOrderOfEachThreadThatPuts) {
  Metrics metrics;
  WorkerPool reader(1);
  const Letters letters;
  {
    Mailbox mailbox([&](Task task) { reader.post(std::move(task)); }, metrics);
    std::vector<std::thread> writers;
    for (std::uint32_t t = 0; t < 3; ++t) {
      writers.emplace_back([&, t] {
        for (std::uint32_t i = 0; i < 3000; ++i) mailbox.put({letters.packet(t * 10'000 + i), letters.to});
      });
    }
    for (std::thread& writer : writers) writer.join();
    reader.stop();  // carries out what waits
  }
  ASSERT_EQ(letters.sink->sequences.size(), 9000U);
  std::vector<std::uint32_t> next{0, 10'000, 20'000};
  for (const std::uint32_t sequence : letters.sink->sequences) EXPECT_EQ(sequence, next[sequence / 10'000]++);
}

}  // namespace
}  // namespace tweend::streams
