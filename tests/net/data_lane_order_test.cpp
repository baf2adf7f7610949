#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "server/net/data_lane.hpp"
#include "tests/net/made_packets.hpp"

namespace tweend::net {
namespace {

// What becomes of a packet is worked out again here plainly, over one sequence of all that was offered.
TEST(DataLaneOrder, ManyStreamsKeepTheirTurnsWhateverHappensBetween) {
  Metrics metrics;
  DataLane lane(metrics);
  struct Waiting {
    std::uint32_t stream, sequence;
  };
  std::vector<Waiting> expected;
  std::vector<std::uint32_t> next(9, 0);
  std::mt19937 random(7);
  bool begun = false;
  const auto its = [](std::uint32_t stream) { return [stream](const Waiting& w) { return w.stream == stream; }; };
  const auto offer_to = [&](std::uint32_t stream, bool key) {
    const std::uint32_t sequence = next[stream]++;
    key = key || sequence == 0;
    const auto first_waiting = expected.begin() + (begun ? 1 : 0);
    const auto first = std::find_if(first_waiting, expected.end(), its(stream));
    if (stream % 2 == 0 && key && first != expected.end()) {
      first->sequence = sequence;
      expected.erase(std::remove_if(first + 1, expected.end(), its(stream)), expected.end());
    } else {
      expected.push_back({stream, sequence});
    }
    lane.offer(stream, test::make_packet(sequence, key ? protocol::kFlagKey : 0, stream), 0);
  };
  for (std::uint32_t stream = 1; stream <= 8; ++stream) lane.expect(stream, {.every = stream % 2 == 1});
  std::size_t most = 0;
  for (int step = 0; step < 5'000; ++step) {
    const auto what = random() % 16;
    const auto stream = static_cast<std::uint32_t>(1 + random() % 8);
    if (what < 8) {
      offer_to(stream, next[stream] % 5 == 0);  // shorter than a chain may be
    } else if (what < 15 && !expected.empty()) {
      what < 10 ? lane.begin_front() : lane.pop_front(0);
      begun = what < 10;
      if (!begun) expected.erase(expected.begin());
    } else if (random() % 64 == 0) {
      lane.forget(stream);
      expected.erase(std::remove_if(expected.begin() + (begun ? 1 : 0), expected.end(), its(stream)), expected.end());
      next[stream] = 0;
      lane.expect(stream, {.every = stream % 2 == 1});
    }
    most = std::max(most, lane.size());
    ASSERT_EQ(lane.size(), expected.size()) << step;
    auto entry = lane.entries().begin();
    for (const Waiting& w : expected) {
      ASSERT_EQ(entry->stream, w.stream) << step;
      ASSERT_EQ(entry->packet->header.sequence, w.sequence) << step;
      ++entry;
    }
  }
  EXPECT_GT(most, 30U);
}

}  // namespace
}  // namespace tweend::net
