#include "protocol/packet.hpp"

#include <fmt/format.h>

#include "protocol/little_endian.hpp"

namespace tweend::protocol {

PacketHeaderBytes encode_header(const PacketHeader& header) noexcept {
  PacketHeaderBytes bytes{};
  put(&bytes[0], kPacketMagic);
  bytes[4] = std::byte{kPacketVersion};
  bytes[5] = static_cast<std::byte>(header.kind);
  bytes[6] = std::byte{header.encoding};
  bytes[7] = std::byte{header.flags};
  put(&bytes[8], header.stream);
  put(&bytes[12], header.sequence);
  put(&bytes[16], static_cast<std::uint64_t>(header.media_us));
  put(&bytes[24], static_cast<std::uint64_t>(header.server_us));
  put(&bytes[32], header.revision);
  put(&bytes[36], header.payload_bytes);
  return bytes;
}

Result<PacketHeader> decode_header(std::span<const std::byte, kPacketHeaderBytes> bytes) {
  if (const auto magic = get<std::uint32_t>(&bytes[0]); magic != kPacketMagic) {
    return fail(ErrorCode::Parse,
                fmt::format("expected a packet that starts with {:#010x}, found {:#010x}", kPacketMagic, magic));
  }
  if (bytes[4] != std::byte{kPacketVersion}) {
    return fail(ErrorCode::Parse,
                fmt::format("expected packet version {}, found {}", kPacketVersion, std::to_integer<int>(bytes[4])));
  }
  const auto kind = std::to_integer<std::uint8_t>(bytes[5]);
  if (kind < 1 || kind > 3) return fail(ErrorCode::Parse, fmt::format("expected packet kind 1, 2 or 3, found {}", kind));
  PacketHeader header;
  header.kind = static_cast<PacketKind>(kind);
  header.encoding = std::to_integer<std::uint8_t>(bytes[6]);
  header.flags = std::to_integer<std::uint8_t>(bytes[7]);
  header.stream = get<std::uint32_t>(&bytes[8]);
  header.sequence = get<std::uint32_t>(&bytes[12]);
  header.media_us = static_cast<std::int64_t>(get<std::uint64_t>(&bytes[16]));
  header.server_us = static_cast<std::int64_t>(get<std::uint64_t>(&bytes[24]));
  header.revision = get<std::uint32_t>(&bytes[32]);
  header.payload_bytes = get<std::uint32_t>(&bytes[36]);
  return header;
}

}  // namespace tweend::protocol
