#include "server/streams/packet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <set>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/allocations.hpp"

namespace tweend::streams {
namespace {

using test::allocations;

TEST(Payload, HasTheSizeAskedForAndKeepsItsMemory) {
  Payload payload;
  EXPECT_TRUE(payload.bytes().empty());
  EXPECT_EQ(payload.resize_floats(24).size(), 24U);
  EXPECT_EQ(payload.bytes().size(), 96U);
  const std::byte* const memory = payload.bytes().data();
  EXPECT_EQ(payload.resize(3).size(), 3U);
  EXPECT_TRUE(payload.floats().empty());
  EXPECT_EQ(payload.resize(96).data(), memory);
}

TEST(Payload, CopiesBytesIntoRoomForTheseAlone) {
  Payload payload;
  const std::array bytes{std::byte{3}, std::byte{5}, std::byte{7}};
  payload.assign(bytes);
  EXPECT_TRUE(std::ranges::equal(payload.bytes(), bytes));
  EXPECT_EQ(payload.capacity(), 3U);
  const std::byte* const memory = payload.bytes().data();
  payload.assign(std::span(bytes).last(2));
  EXPECT_EQ(payload.bytes().data(), memory) << "which it keeps";
  EXPECT_TRUE(std::ranges::equal(payload.bytes(), std::span(bytes).last(2)));
  payload.assign({});
  EXPECT_TRUE(payload.bytes().empty());
}

TEST(PacketPool, GivesTheSamePacketAgainWithAFreshHeader) {
  const auto pool = std::make_shared<PacketPool>();
  auto packet = pool->take();
  packet->header.sequence = 77;
  packet->header.flags = protocol::kFlagLast;
  packet->view_serial = 9;
  const Packet* first = packet.get();
  const std::byte* payload = packet->payload.resize(24).data();
  packet.reset();
  packet = pool->take();
  EXPECT_EQ(packet.get(), first);
  EXPECT_EQ(packet->payload.resize(24).data(), payload);
  EXPECT_EQ(packet->header, protocol::PacketHeader{});
  EXPECT_EQ(packet->view_serial, 0U);
}

TEST(PacketPool, NeverGivesAPacketThatSomebodyReads) {
  const auto pool = std::make_shared<PacketPool>();
  std::vector<PacketPtr> held;
  std::set<const Packet*> addresses;
  for (int i = 0; i < 20; ++i) {
    held.push_back(pool->take());
    EXPECT_TRUE(addresses.insert(held.back().get()).second);
  }
  const PacketPtr reader = held.front();
  held.clear();
  for (int i = 0; i < 20; ++i) {
    held.push_back(pool->take());
    EXPECT_NE(held.back(), reader);
  }
}

TEST(PacketPool, TakesNoMemoryOnceItIsWarm) {
  const auto pool = std::make_shared<PacketPool>();
  const auto run = [&](int rounds) {
    PacketPtr latest;
    PacketPtr on_a_socket;
    for (int i = 0; i < rounds; ++i) {
      const NewPacketPtr made = pool->take();
      made->payload.resize_floats(6000);
      on_a_socket = latest;
      latest = made;
    }
  };
  run(10);
  const std::size_t before = allocations();
  run(1000);
  EXPECT_EQ(allocations(), before);
  const std::vector<int> some(100);
  EXPECT_GT(allocations(), before) << "the counter counts " << some.size();
}

TEST(PacketPool, MayGoBeforeItsPackets) {
  auto pool = std::make_shared<PacketPool>();
  const std::weak_ptr<PacketPool> watched = pool;
  PacketPtr packet = pool->take();
  pool.reset();
  EXPECT_FALSE(watched.expired()) << "a packet on a socket needs it to come home";
  packet.reset();
  EXPECT_TRUE(watched.expired()) << "packets at home do not keep it";
}

TEST(PacketPool, LetsGoOfPacketsBeyondAFew) {
  const auto pool = std::make_shared<PacketPool>();
  std::vector<PacketPtr> many;
  for (int i = 0; i < 100; ++i) many.push_back(pool->take());
  many.clear();
  const std::size_t at_rest = allocations();
  for (int i = 0; i < 100; ++i) many.push_back(pool->take());
  EXPECT_GT(allocations(), at_rest) << "a burst is not kept for ever";
}

TEST(PacketPool, ServesManyThreads) {
  const auto pool = std::make_shared<PacketPool>();
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 2000; ++i) {
        const auto packet = pool->take();
        for (float& value : packet->payload.resize_floats(8)) value = static_cast<float>(t);
        std::vector<PacketPtr> readers(3, packet);
        for (const float value : readers.back()->payload.floats()) wrong += value == static_cast<float>(t) ? 0 : 1;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace tweend::streams
