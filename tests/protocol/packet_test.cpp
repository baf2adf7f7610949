#include "protocol/packet.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace tweend::protocol {
namespace {

/// Written out by hand from the table of docs/PROTOCOL.md, section 6.
constexpr std::array<unsigned char, 40> kByHand{
    'T',  'W',  'N',  'D',                           //  0 magic 0x444E5754, little-endian
    1,                                               //  4 version
    2,                                               //  5 kind: vertices
    0,                                               //  6 encoding: f32
    7,                                               //  7 flags: key, discontinuity, last
    0x04, 0x03, 0x02, 0x01,                          //  8 stream 0x01020304
    0xFE, 0xFF, 0xFF, 0xFF,                          // 12 sequence 4294967294
    0x40, 0xE2, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00,  // 16 media time 123456 µs
    0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF,  // 24 clock reading -1 µs
    0x01, 0x00, 0x00, 0x80,                          // 32 revision 0x80000001
    0x18, 0x00, 0x00, 0x00,                          // 36 payload of 24 bytes
};

constexpr PacketHeader kHeader{PacketKind::Vertices, 0, 7, 0x01020304, 4294967294U, 123456, -1, 0x80000001U, 24};

PacketHeaderBytes by_hand() {
  PacketHeaderBytes bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = std::byte{kByHand[i]};
  return bytes;
}

std::vector<int> numbers(const PacketHeaderBytes& bytes) {
  std::vector<int> out;
  for (const std::byte b : bytes) out.push_back(std::to_integer<int>(b));
  return out;
}

TEST(PacketHeader, IsWrittenByteByByteAsTheTableSays) { EXPECT_EQ(numbers(encode_header(kHeader)), numbers(by_hand())); }

TEST(PacketHeader, IsReadByteByByteAsTheTableSays) {
  const auto header = decode_header(by_hand());
  ASSERT_TRUE(header);
  EXPECT_EQ(*header, kHeader);
}

TEST(PacketHeader, RoundTripsTheExtremesOfEachField) {
  for (const auto kind : {PacketKind::Pose, PacketKind::Vertices, PacketKind::Frame}) {
    for (const std::int64_t time :
         {std::int64_t{0}, std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
      for (const std::uint32_t number : {0U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
        const PacketHeader header{kind, 255, 255, number, ~number, time, -(time + 1), number, ~number};
        const auto back = decode_header(encode_header(header));
        ASSERT_TRUE(back);
        EXPECT_EQ(*back, header);
      }
    }
  }
}

TEST(PacketHeader, NoFieldReachesIntoAnother) {
  const auto clean = numbers(encode_header(PacketHeader{PacketKind::Pose, 0, 0, 0, 0, 0, 0, 0, 0}));
  struct Field {
    PacketHeader header;
    std::size_t at, size;
  };
  std::vector<Field> fields(8);
  for (Field& f : fields) f.header.kind = PacketKind::Pose;
  fields[0].header.encoding = 255, fields[0].at = 6, fields[0].size = 1;
  fields[1].header.flags = 255, fields[1].at = 7, fields[1].size = 1;
  fields[2].header.stream = 0xFFFFFFFF, fields[2].at = 8, fields[2].size = 4;
  fields[3].header.sequence = 0xFFFFFFFF, fields[3].at = 12, fields[3].size = 4;
  fields[4].header.media_us = -1, fields[4].at = 16, fields[4].size = 8;
  fields[5].header.server_us = -1, fields[5].at = 24, fields[5].size = 8;
  fields[6].header.revision = 0xFFFFFFFF, fields[6].at = 32, fields[6].size = 4;
  fields[7].header.payload_bytes = 0xFFFFFFFF, fields[7].at = 36, fields[7].size = 4;
  for (const Field& f : fields) {
    auto expected = clean;
    for (std::size_t i = 0; i < f.size; ++i) expected[f.at + i] = 255;
    EXPECT_EQ(numbers(encode_header(f.header)), expected) << "field at " << f.at;
  }
}

TEST(PacketHeader, RefusesAnyOtherMagicVersionOrKind) {
  for (std::size_t i = 0; i < 6; ++i) {
    for (int value = 0; value < 256; ++value) {
      const bool good = value == kByHand[i] || (i == 5 && value >= 1 && value <= 3);
      PacketHeaderBytes bytes = by_hand();
      bytes[i] = static_cast<std::byte>(value);
      const auto header = decode_header(bytes);
      ASSERT_EQ(header.has_value(), good) << value << " at byte " << i;
      if (good) continue;
      EXPECT_EQ(header.error().code, ErrorCode::Parse);
      EXPECT_FALSE(header.error().message.empty());
    }
  }
}

}  // namespace
}  // namespace tweend::protocol
