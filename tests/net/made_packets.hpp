#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "server/streams/packet.hpp"

namespace tweend::test {

/// What a test says of a packet; the rest is as a producer of vertices would have it.
struct PacketSpec {
  std::uint32_t sequence = 0;
  std::uint8_t flags = protocol::kFlagKey;
  std::uint64_t source = 1;
  std::int64_t server_us = -1;  ///< -1: later than all packets before it
  std::size_t floats = 6;       ///< 0, 1, 2 and so on
  std::uint8_t encoding = protocol::kVerticesF32;
};

inline streams::PacketPtr make_packet(const PacketSpec& spec) {
  static const auto pool = std::make_shared<streams::PacketPool>();
  static std::int64_t clock_us = 0;
  clock_us += 1000;
  const auto packet = pool->take();
  const auto numbers = packet->payload.resize_floats(spec.floats);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i);
  packet->source = spec.source;
  packet->header.encoding = spec.encoding;
  packet->header.sequence = spec.sequence;
  packet->header.flags = spec.flags;
  packet->header.server_us = spec.server_us < 0 ? clock_us : spec.server_us;
  packet->header.payload_bytes = static_cast<std::uint32_t>(4 * spec.floats);
  return packet;
}

inline streams::PacketPtr make_packet(std::uint32_t sequence, std::uint8_t flags = protocol::kFlagKey,
                                      std::uint64_t source = 1) {
  return make_packet(PacketSpec{.sequence = sequence, .flags = flags, .source = source});
}

}  // namespace tweend::test
