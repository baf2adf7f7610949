#include "server/net/data_lane.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "tests/net/made_packets.hpp"
#include "tests/support/allocations.hpp"

namespace tweend::net {
namespace {

using protocol::kFlagDiscontinuity, protocol::kFlagKey, protocol::kFlagLast;
using test::make_packet;

constexpr commands::StreamPolicy kEvery{.every = true};

class DataLaneTest : public ::testing::Test {
 protected:
  void offer(std::uint32_t sequence, std::uint8_t flags = kFlagKey, std::uint64_t source = 1) {
    lane.offer(1, make_packet(sequence, flags, source), 0);
  }
  /// The numbers of what waits.
  std::vector<std::uint32_t> waiting() const {
    std::vector<std::uint32_t> numbers;
    for (const DataLane::Entry& entry : lane.entries()) numbers.push_back(entry.sequence);
    return numbers;
  }
  const DataLane::Entry& second() const { return *std::next(lane.entries().begin()); }
  /// Writes all, and tells the numbers.
  std::vector<std::uint32_t> write() {
    const auto numbers = waiting();
    while (lane.size() > 0) lane.pop_front(0);
    return numbers;
  }
  std::int64_t skipped() const { return metrics.packets_skipped_total.load(); }

  using Numbers = std::vector<std::uint32_t>;
  Metrics metrics;
  DataLane lane{metrics};
};

TEST_F(DataLaneTest, ANewerPacketReplacesTheOneThatWaits) {
  offer(0);
  offer(1, kFlagKey | kFlagDiscontinuity);
  offer(2);
  EXPECT_EQ(waiting(), Numbers{2});
  EXPECT_EQ(lane.front().flags, kFlagKey | kFlagDiscontinuity) << "what was skipped has jumped";
  EXPECT_EQ(skipped(), 2);
}

TEST_F(DataLaneTest, OnlyADiscontinuityIsCarriedOverAndOnlyOnce) {
  offer(0, kFlagKey | kFlagLast | kFlagDiscontinuity);
  offer(1);
  EXPECT_EQ(lane.front().flags, kFlagKey | kFlagDiscontinuity);
  write();
  offer(2);
  EXPECT_EQ(lane.front().flags, kFlagKey);
}

TEST_F(DataLaneTest, APacketThatIsBeingWrittenIsNotReplaced) {
  offer(0);
  lane.begin_front();
  offer(1);
  offer(2);
  EXPECT_EQ(waiting(), (Numbers{0, 2}));
  EXPECT_EQ(skipped(), 1);
}

TEST_F(DataLaneTest, ReplacingKeepsTheTurnOfTheStream) {
  offer(0);
  lane.offer(2, make_packet(0), 0);
  offer(5);  // stream 1 has waited longer and still goes first
  ASSERT_EQ(lane.size(), 2U);
  EXPECT_EQ(lane.front().stream, 1U);
  EXPECT_EQ(lane.front().sequence, 5U);
  EXPECT_EQ(second().stream, 2U);
}

TEST_F(DataLaneTest, AStreamBeginsWithAKeyAndMissesNothingBeforeIt) {
  offer(3, 0);
  offer(4, kFlagDiscontinuity);
  EXPECT_EQ(lane.size(), 0U);
  EXPECT_EQ(skipped(), 0);
  offer(5);
  offer(6, 0);
  EXPECT_EQ(waiting(), (Numbers{5, 6}));
  EXPECT_EQ(lane.front().flags, kFlagKey);
}

TEST_F(DataLaneTest, APacketFollowsItsPredecessorWhereverThatIs) {
  offer(0);
  offer(1, 0);
  EXPECT_EQ(write(), (Numbers{0, 1}));
  offer(2, 0);  // its predecessor was sent
  lane.begin_front();
  offer(3, 0);  // is being written
  offer(4, 0);  // waits
  EXPECT_EQ(waiting(), (Numbers{2, 3, 4}));
  EXPECT_EQ(skipped(), 0);
}

TEST_F(DataLaneTest, WithoutItsPredecessorAPacketIsOfNoUse) {
  offer(0);
  write();
  offer(2, 0);
  EXPECT_EQ(lane.size(), 0U);
  offer(3, 0);
  EXPECT_EQ(skipped(), 2) << "2 was dropped, and so 3 lacks its own";
  offer(4);
  offer(5, 0);
  EXPECT_EQ(waiting(), (Numbers{4, 5}));
}

TEST_F(DataLaneTest, AKeyReplacesTheWholeChain) {
  offer(0);
  write();
  offer(1, 0);
  lane.begin_front();
  offer(2, kFlagDiscontinuity);
  lane.offer(2, make_packet(0), 0);
  offer(3, 0);
  offer(4);
  ASSERT_EQ(waiting(), (Numbers{1, 4, 0})) << "what is being written stays, and so does the other stream's";
  EXPECT_EQ(second().flags, kFlagKey | kFlagDiscontinuity);
  EXPECT_EQ(skipped(), 2);
  EXPECT_EQ(write(), (Numbers{1, 4, 0}));
}

TEST_F(DataLaneTest, AChainOfEightIsKeptAndALongerOneIsDropped) {
  offer(0);
  for (std::uint32_t i = 1; i < 8; ++i) offer(i, i == 3 ? kFlagDiscontinuity : 0);
  EXPECT_EQ(waiting(), (Numbers{0, 1, 2, 3, 4, 5, 6, 7}));
  offer(8, 0);
  EXPECT_EQ(lane.size(), 0U);
  EXPECT_EQ(skipped(), 9);
  offer(9, 0);
  EXPECT_EQ(skipped(), 10);
  offer(10);
  EXPECT_EQ(waiting(), Numbers{10});
  EXPECT_EQ(lane.front().flags, kFlagKey | kFlagDiscontinuity) << "3 has jumped";
}

TEST_F(DataLaneTest, AChainIsBoundedInBytesToo) {
  const auto large = [](std::uint32_t sequence, std::uint8_t flags) {
    return make_packet({.sequence = sequence, .flags = flags, .floats = DataLane::kChainBytes / 4 / 3 + 1});
  };
  lane.offer(1, large(0, kFlagKey), 0);
  lane.offer(1, large(1, 0), 0);
  EXPECT_EQ(lane.size(), 2U);
  lane.offer(1, large(2, 0), 0);
  EXPECT_EQ(lane.size(), 0U) << "three of a third and a float";
  lane.offer(1, make_packet({.sequence = 3, .floats = DataLane::kChainBytes}), 0);
  EXPECT_EQ(lane.size(), 1U) << "a single packet may have any size";
}

TEST_F(DataLaneTest, NumbersGoOnWhereAnotherProducerTakesOverAndGapsStayGaps) {
  offer(41, kFlagKey, 5);
  EXPECT_EQ(write(), Numbers{41});
  offer(7, kFlagKey, 6);
  EXPECT_EQ(write(), Numbers{42});
  offer(10, kFlagKey, 6);
  EXPECT_EQ(write(), Numbers{45});
  offer(11, kFlagKey, 6);  // replaced before it is written
  offer(20, kFlagKey, 7);
  EXPECT_EQ(write(), Numbers{47}) << "46 was never seen";
}

TEST_F(DataLaneTest, NumbersStartAgainAfterTheLastOne) {
  offer(0xFFFFFFFFU, kFlagKey, 5);
  offer(9, kFlagKey, 6);
  EXPECT_EQ(write(), Numbers{0});
  for (const std::uint32_t sequence : {0xFFFFFFFEU, 0xFFFFFFFFU, 0U, 1U}) {
    lane.offer(2, make_packet(sequence, sequence == 0xFFFFFFFEU ? kFlagKey : 0), 0);
  }
  EXPECT_EQ(write(), (Numbers{0xFFFFFFFEU, 0xFFFFFFFFU, 0, 1}));
}

TEST_F(DataLaneTest, EachStreamHasItsOwnNumbersAndAForgottenOneHasNone) {
  offer(7, kFlagKey, 5);
  lane.offer(2, make_packet(3, kFlagKey, 6), 0);
  EXPECT_EQ(write(), (Numbers{7, 3}));
  lane.forget(1);
  EXPECT_FALSE(lane.knows(1));
  offer(100, kFlagKey, 6);
  EXPECT_EQ(write(), Numbers{100});
}

// Who leaves a producer and comes back to it is given its latest packet: perhaps one that it has had.
TEST_F(DataLaneTest, TakesNoPacketTwice) {
  offer(3, kFlagKey, 7);
  offer(3, kFlagKey, 7);
  offer(2, kFlagKey, 7);
  EXPECT_EQ(write(), Numbers{3});
  offer(3, kFlagKey, 7);
  EXPECT_EQ(lane.size(), 0U);
  EXPECT_EQ(skipped(), 0);
}

TEST_F(DataLaneTest, AnotherProducersPacketOfTheSameMomentIsNoNews) {
  const auto at = [](std::int64_t us, std::uint64_t source, std::uint8_t flags = kFlagKey, std::uint32_t sequence = 0) {
    return make_packet({.sequence = sequence, .flags = flags, .source = source, .server_us = us});
  };
  lane.offer(1, at(500, 1), 0);
  write();
  lane.offer(1, at(500, 2), 0);
  lane.offer(1, at(400, 2), 0);
  EXPECT_EQ(lane.size(), 0U);
  EXPECT_EQ(skipped(), 0) << "nothing is missed";
  lane.offer(1, make_packet({.source = 2, .server_us = 400, .encoding = protocol::kVerticesQ16}), 0);
  EXPECT_EQ(lane.size(), 0U) << "of this encoding each packet is a key, too";
  lane.offer(1, at(501, 2, kFlagKey, 1), 0);
  EXPECT_EQ(write(), Numbers{1}) << "no gap either";
  lane.offer(1, at(501, 3, kFlagKey | kFlagLast), 0);
  EXPECT_EQ(write(), Numbers{2}) << "the last picture stays, and is to be the best";
}

TEST_F(DataLaneTest, AKeyThatOthersNeedIsNewsAtAnyMoment) {
  const auto meshopt = [](std::uint32_t sequence, std::uint8_t flags, std::uint64_t source) {
    return make_packet(
        {.sequence = sequence, .flags = flags, .source = source, .server_us = 500, .encoding = protocol::kVerticesMeshopt});
  };
  lane.offer(1, meshopt(0, kFlagKey, 1), 0);
  write();
  lane.offer(1, meshopt(8, 0, 2), 0);
  EXPECT_EQ(lane.size(), 0U) << "its predecessor is another producer's";
  lane.offer(1, meshopt(9, kFlagKey, 2), 0);
  lane.offer(1, meshopt(10, 0, 2), 0);
  EXPECT_EQ(write(), (Numbers{2, 3}));
}

TEST_F(DataLaneTest, EverySkipsNothing) {
  lane.expect(1, kEvery);
  offer(0, 0);  // it, too, begins with a key
  for (std::uint32_t i = 1; i <= 100; ++i) offer(i, i % 10 == 1 ? kFlagKey : 0);
  EXPECT_EQ(lane.size(), 100U);
  EXPECT_EQ(lane.behind(), std::nullopt);
  const Numbers numbers = write();
  for (std::uint32_t i = 0; i < 100; ++i) ASSERT_EQ(numbers[i], i + 1);
  EXPECT_EQ(skipped(), 0);
  EXPECT_EQ(lane.every_bytes(), 0U);
}

TEST_F(DataLaneTest, EveryIsBoundedInBytesAndByThemInPackets) {
  lane.expect(3, kEvery);
  lane.expect(4, kEvery);
  // Two streams count together; each packet for its payload, and a small one for 4 KiB.
  for (const std::size_t floats : {0U, 6U, 1024U, 1500U}) {
    const std::size_t each = std::max<std::size_t>(4096, 4 * floats);
    const std::size_t most = (std::size_t{16} << 20U) / each;
    DataLane both(metrics);
    both.expect(3, kEvery);
    both.expect(4, kEvery);
    for (std::uint32_t i = 0; i < most; ++i) {
      both.offer(3 + i % 2, make_packet({.sequence = i, .floats = floats}), 0);
    }
    EXPECT_EQ(both.every_bytes(), most * each);
    EXPECT_EQ(both.behind(), std::nullopt);
    both.offer(3, make_packet({.sequence = 100'000, .floats = floats}), 0);
    EXPECT_EQ(both.behind(), std::optional<std::uint32_t>(3)) << floats;
    both.begin_front();
    EXPECT_EQ(both.behind(), std::nullopt) << "what is being written does not wait";
    both.drop_waiting();
    EXPECT_EQ(both.size(), 1U);
    EXPECT_EQ(both.every_bytes(), 0U);
  }
}

TEST_F(DataLaneTest, BehindIsAStreamThatGoesOn) {
  const auto large = [](std::uint32_t sequence) {
    return make_packet({.sequence = sequence, .floats = DataLane::kEveryBytes / 4 / 4});
  };
  for (const std::uint32_t stream : {1U, 2U, 3U}) lane.expect(stream, kEvery);
  for (std::uint32_t i = 0; i < 3; ++i) lane.offer(1, large(i), 0);
  lane.offer(2, make_packet(0), 0);
  for (std::uint32_t i = 0; i < 2; ++i) lane.offer(3, large(i), 0);
  EXPECT_EQ(lane.behind(), std::optional<std::uint32_t>(1)) << "of it most waits";
  lane.end(1);
  EXPECT_EQ(lane.behind(), std::optional<std::uint32_t>(3));
  lane.end(3);
  EXPECT_EQ(lane.behind(), std::optional<std::uint32_t>(2));
  lane.end(2);
  EXPECT_EQ(lane.behind(), std::nullopt) << "it gets no more";
  EXPECT_EQ(write().size(), 6U);
  EXPECT_EQ(lane.every_bytes(), 0U);
}

TEST_F(DataLaneTest, AWordStaysBehindThePacketsAndAStreamThatEndedStillSendsThem) {
  offer(0);
  lane.end(1);
  lane.push_word(std::make_shared<const std::string>("ended"));
  EXPECT_FALSE(lane.knows(1));
  ASSERT_EQ(lane.size(), 2U);
  EXPECT_TRUE(lane.front().packet);
  EXPECT_EQ(*second().word, "ended");
}

TEST_F(DataLaneTest, WhatIsDroppedGivesItsWordsBack) {
  offer(0);
  lane.begin_front();
  lane.push_word(std::make_shared<const std::string>("first"));
  offer(1);
  lane.push_word(std::make_shared<const std::string>("second"));
  const auto words = lane.drop_waiting();
  ASSERT_EQ(words.size(), 2U);
  EXPECT_EQ(*words[0], "first");
  EXPECT_EQ(*words[1], "second");
  EXPECT_EQ(waiting(), Numbers{0});
  EXPECT_TRUE(lane.drop_waiting().empty());
}

TEST_F(DataLaneTest, ForgettingLeavesWhatHasBegun) {
  offer(0);
  lane.begin_front();
  offer(1);
  lane.offer(2, make_packet(5), 0);
  lane.forget(1);
  EXPECT_EQ(waiting(), (Numbers{0, 5}));
  EXPECT_EQ(write(), (Numbers{0, 5}));
}

TEST_F(DataLaneTest, CountsByStreamWhatBecomesOfItsPackets) {
  const auto meter = std::make_shared<streams::StreamMeter>();
  const auto pool = std::make_shared<streams::PacketPool>(meter);
  const auto counts = [&] {
    return std::vector<std::int64_t>{meter->queued.load(), meter->sent.load(), meter->skipped.load()};
  };
  using Counts = std::vector<std::int64_t>;
  const auto packet = [&pool](std::uint32_t sequence) {
    const auto made = pool->take();
    made->header.sequence = sequence;
    made->header.flags = kFlagKey;
    return made;
  };
  {
    DataLane other(metrics);
    lane.offer(1, packet(0), 0);
    other.offer(1, packet(0), 0);
    EXPECT_EQ(counts(), (Counts{0, 0, 0})) << "it may leave at once";
    lane.settle_in();
    other.settle_in();
    lane.settle_in();
    EXPECT_EQ(counts(), (Counts{2, 0, 0}));
    lane.offer(1, packet(1), 0);
    EXPECT_EQ(counts(), (Counts{2, 0, 1}));
    lane.pop_front(0);
    EXPECT_EQ(counts(), (Counts{1, 1, 1}));
    lane.offer(1, packet(2), 0);
    lane.settle_in();
    lane.forget(1);
    EXPECT_EQ(counts(), (Counts{1, 1, 1}));
    other.begin_front();
    other.drop_waiting();
    EXPECT_EQ(counts(), (Counts{1, 1, 1}));
  }
  EXPECT_EQ(counts(), (Counts{0, 1, 1})) << "a connection that is gone has nothing waiting";
}

TEST_F(DataLaneTest, RefinedStillsDoNotSpeakOfTheRung) {
  lane.expect(1, {.adaptive = true});
  std::int64_t now_us = 0;
  std::uint32_t sequence = 0;
  const auto send = [&](std::uint8_t flags, std::int64_t waited_us) {
    lane.offer(1, make_packet(sequence++, flags), now_us);
    lane.pop_front(now_us += waited_us);
  };
  const auto rung_after = [&](int packets, std::uint8_t flags) {
    std::optional<std::size_t> rung;
    for (int i = 0; i < packets; ++i) {
      send(flags, 400'000);
      if (const auto move = lane.next_move()) rung = move->rung;
    }
    return rung;
  };
  constexpr std::uint8_t kStill = kFlagKey | kFlagLast;
  EXPECT_EQ(rung_after(4, kStill), std::optional<std::size_t>(1)) << "at the top they are as all others";
  lane.offer(1, make_packet(0, kFlagKey, 2), now_us);  // the new rung's producer takes over
  lane.pop_front(now_us);
  const auto refined = [&](int packets) {
    for (int i = 0; i < packets; ++i) {
      lane.offer(1, make_packet(++sequence, kStill, 2), now_us);
      now_us += 400'000;
      if (i % 2 == 0) lane.pop_front(now_us);
    }
    return lane.next_move();
  };
  sequence = 0;
  EXPECT_FALSE(refined(20));
  if (lane.size() > 0) lane.pop_front(now_us);
  for (int i = 0; i < 3; ++i) {
    lane.offer(1, make_packet(++sequence, kFlagKey, 2), now_us);
    lane.pop_front(now_us += 400'000);
  }
  EXPECT_TRUE(lane.next_move());
}

TEST_F(DataLaneTest, TakesNoMemoryForAPacketOnceItHasGrown) {
  lane.expect(2, kEvery);
  std::vector<streams::PacketPtr> packets;
  for (std::uint32_t i = 0; i < 200; ++i) packets.push_back(make_packet(i, i % 16 == 0 ? kFlagKey : 0));
  const auto run = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      lane.offer(1, packets[i], 0);
      lane.offer(2, packets[i], 0);
      while (i % 8 == 7 && lane.size() > 0) lane.pop_front(0);
    }
  };
  run(0, 40);
  const std::size_t before = test::allocations();
  run(40, 200);
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace tweend::net
