#include "server/net/outbox.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>

namespace tweend::net {
namespace {

using streams::Packet;
using streams::PacketPool;
using streams::PacketPtr;

PacketPtr make_packet(std::uint32_t sequence, std::uint8_t flags = protocol::kFlagKey, std::uint64_t source = 1) {
  static const auto pool = std::make_shared<PacketPool>();
  const auto packet = pool->take();
  const auto numbers = packet->payload.resize_floats(6);
  for (std::size_t i = 0; i < 6; ++i) numbers[i] = static_cast<float>(i);
  packet->source = source;
  packet->header.sequence = sequence;
  packet->header.flags = flags;
  packet->header.payload_bytes = 24;
  return packet;
}

std::string bytes_of(Outbox& outbox) {
  std::string all;
  for (const boost::asio::const_buffer& b : outbox.take()) all.append(static_cast<const char*>(b.data()), b.size());
  return all;
}

std::string drain(Outbox& outbox) {
  std::string all;
  for (std::string some = bytes_of(outbox); !some.empty(); some = bytes_of(outbox)) {
    all += some;
    outbox.written();
  }
  return all;
}

/// The header of the packet that follows the announcing line.
protocol::PacketHeader header_in(const std::string& wire) {
  const std::size_t line = wire.find('\n') + 1;
  std::array<std::byte, protocol::kPacketHeaderBytes> bytes;
  std::memcpy(bytes.data(), wire.data() + line, bytes.size());
  const auto header = protocol::decode_header(bytes);
  EXPECT_TRUE(header);
  return header ? *header : protocol::PacketHeader{};
}

class OutboxTest : public ::testing::Test {
 protected:
  Metrics metrics;
  Outbox line{Framing::Line, metrics};
  Outbox web{Framing::WebSocket, metrics};
};

TEST_F(OutboxTest, LineTextEndsInANewline) {
  line.push_text("{\"a\":1}");
  EXPECT_EQ(drain(line), "{\"a\":1}\n");
  EXPECT_TRUE(line.empty());
}

TEST_F(OutboxTest, LinePacketsFollowTheLineThatAnnouncesTheirBytes) {
  line.offer(7, make_packet(3));
  const std::string wire = drain(line);
  const std::string announcement = R"({"jsonrpc":"2.0","method":"stream.packet","params":{"stream":7,"bytes":64}})"
                                   "\n";
  ASSERT_EQ(wire.substr(0, announcement.size()), announcement);
  EXPECT_EQ(wire.size(), announcement.size() + 40 + 24);
  EXPECT_EQ(header_in(wire).stream, 7U);
  EXPECT_EQ(header_in(wire).sequence, 3U);
}

// RFC 6455, section 5.2: 7 bits of length, or 126 and 16 bits, or 127 and 64 bits, big-endian.
TEST_F(OutboxTest, WebSocketFramesHaveTheLengthsOfTheStandard) {
  for (const std::size_t size : {0U, 125U, 126U, 65535U, 65536U}) {
    web.push_text(std::string(size, 'x'));
    const std::string wire = drain(web);
    ASSERT_EQ(static_cast<unsigned char>(wire[0]), 0x81);
    const auto first = static_cast<unsigned char>(wire[1]);
    const std::size_t extra = size < 126 ? 0 : size <= 65535 ? 2 : 8;
    EXPECT_EQ(first, extra == 0 ? size : extra == 2 ? 126U : 127U);
    std::size_t told = extra == 0 ? first : 0;
    for (std::size_t i = 0; i < extra; ++i) told = told * 256 + static_cast<unsigned char>(wire[2 + i]);
    EXPECT_EQ(told, size);
    EXPECT_EQ(wire.size(), 2 + extra + size);
  }
}

TEST_F(OutboxTest, WebSocketPacketsAreOneBinaryMessage) {
  web.offer(1, make_packet(0));
  const std::string wire = drain(web);
  EXPECT_EQ(wire.substr(0, 2), std::string("\x82\x40", 2));
  EXPECT_EQ(wire.size(), 2U + 64U);
}

TEST_F(OutboxTest, ANewerPacketReplacesTheOneThatWaits) {
  line.offer(1, make_packet(0));
  line.offer(1, make_packet(1, protocol::kFlagKey | protocol::kFlagDiscontinuity));
  line.offer(1, make_packet(2));
  const std::string wire = drain(line);
  const protocol::PacketHeader header = header_in(wire);
  EXPECT_EQ(header.sequence, 2U);
  EXPECT_EQ(header.flags, protocol::kFlagKey | protocol::kFlagDiscontinuity) << "what was skipped has jumped";
  EXPECT_EQ(wire.find("stream.packet"), wire.rfind("stream.packet")) << "one packet only";
  EXPECT_EQ(metrics.packets_skipped_total.load(), 2);
  EXPECT_EQ(metrics.packets_sent_total.load(), 1);
}

TEST_F(OutboxTest, AReplacedLastPacketTakesItsFlagAlong) {
  line.offer(1, make_packet(0, protocol::kFlagKey | protocol::kFlagLast));
  line.offer(1, make_packet(1));
  EXPECT_EQ(header_in(drain(line)).flags, protocol::kFlagKey) << "only a discontinuity is carried over";
}

TEST_F(OutboxTest, StreamsDoNotReplaceEachOther) {
  line.offer(1, make_packet(0));
  line.offer(2, make_packet(0));
  EXPECT_EQ(metrics.packets_skipped_total.load(), 0);
  const std::string wire = drain(line);
  EXPECT_NE(wire.find("\"stream\":1,"), std::string::npos);
  EXPECT_NE(wire.find("\"stream\":2,"), std::string::npos);
}

TEST_F(OutboxTest, NumbersGoOnWhereAnotherProducerTakesOver) {
  line.offer(1, make_packet(41, protocol::kFlagKey, 5));
  EXPECT_EQ(header_in(drain(line)).sequence, 41U);
  line.offer(1, make_packet(0, protocol::kFlagKey, 6));
  EXPECT_EQ(header_in(drain(line)).sequence, 42U);
  line.offer(1, make_packet(3, protocol::kFlagKey, 6));
  EXPECT_EQ(header_in(drain(line)).sequence, 45U) << "a gap stays a gap";
}

TEST_F(OutboxTest, AnswersGoBeforePackets) {
  line.offer(1, make_packet(0));
  line.push_text("answer");
  EXPECT_EQ(drain(line).substr(0, 7), "answer\n");
}

TEST_F(OutboxTest, AWordAboutPacketsStaysBehindThem) {
  line.offer(1, make_packet(0));
  line.push_after_packets(std::make_shared<const std::string>("ended"));
  line.push_text("answer");
  line.offer(1, make_packet(1));  // replaces the waiting one, still before the word
  const std::string wire = drain(line);
  EXPECT_EQ(wire.substr(0, 7), "answer\n");
  EXPECT_EQ(wire.substr(wire.size() - 6), "ended\n");
  EXPECT_EQ(header_in(wire.substr(7)).sequence, 1U);
}

TEST_F(OutboxTest, AWordAboutPacketsWaitsForNothingWhereNoneWait) {
  line.push_after_packets(std::make_shared<const std::string>("ended"));
  EXPECT_EQ(drain(line), "ended\n");
}

TEST_F(OutboxTest, ForgottenStreamsSendNothingMore) {
  line.offer(1, make_packet(0));
  line.forget_stream(1);
  EXPECT_TRUE(line.empty());
  EXPECT_EQ(drain(line), "");
}

TEST_F(OutboxTest, PayloadsAreSharedAndNeverCopied) {
  const PacketPtr packet = make_packet(0);
  line.offer(1, packet);
  const auto buffers = line.take();
  ASSERT_EQ(buffers.size(), 2U);
  EXPECT_EQ(buffers[1].data(), packet->payload.bytes().data());
}

TEST_F(OutboxTest, AWriteGathersAtMostThirtyTwoMessages) {
  for (int i = 0; i < 40; ++i) line.push_text("x");
  EXPECT_EQ(bytes_of(line).size(), 64U);
  line.written();
  EXPECT_EQ(bytes_of(line).size(), 16U);
}

TEST_F(OutboxTest, UnreadAnswersCongestAndAreRelievedByWriting) {
  line.push_text(std::string(Outbox::kCongestedBytes, 'x'));
  EXPECT_FALSE(line.congested());
  line.push_text("y");
  EXPECT_TRUE(line.congested());
  static_cast<void>(line.take());
  EXPECT_TRUE(line.congested()) << "what is being written has not been taken yet";
  line.written();
  EXPECT_FALSE(line.congested());
  EXPECT_FALSE(line.overflowed()) << "answers hold the client back instead";
}

TEST_F(OutboxTest, UnreadEventsOverflow) {
  const auto event = std::make_shared<const std::string>(std::string(1U << 20U, 'x'));
  for (int i = 0; i < 8; ++i) line.push_shared(event);
  EXPECT_FALSE(line.overflowed());
  line.push_shared(event);
  EXPECT_TRUE(line.overflowed());
  static_cast<void>(drain(line));
  EXPECT_FALSE(line.overflowed());
}

TEST_F(OutboxTest, RawBytesLeaveAsTheyAre) {
  web.push_raw(std::string("\x8a\x00", 2));
  EXPECT_EQ(drain(web), std::string("\x8a\x00", 2));
}

/// Header and payload of make_packet(), written out by hand from section 6's table.
std::string packet_bytes(std::uint32_t stream, std::uint32_t sequence) {
  const auto u32 = [](std::uint32_t v) {
    std::string text;
    for (unsigned shift = 0; shift < 32; shift += 8) text += static_cast<char>(static_cast<unsigned char>(v >> shift));
    return text;
  };
  std::string all("TWND\x01\x02\x00\x01", 8);
  all += u32(stream) + u32(sequence) + std::string(20, '\0') + u32(24);
  for (const std::uint32_t bits : {0x00000000U, 0x3F800000U, 0x40000000U, 0x40400000U, 0x40800000U, 0x40A00000U}) {
    all += u32(bits);  // 0 to 5 as float32
  }
  return all;
}

TEST_F(OutboxTest, PacketsAreTheSameBytesInBothFramings) {
  const PacketPtr packet = make_packet(0x01020304);
  line.offer(4000000000U, packet);
  std::string expected = R"({"jsonrpc":"2.0","method":"stream.packet","params":{"stream":4000000000,"bytes":64}})";
  expected += '\n';
  expected += packet_bytes(4000000000U, 0x01020304);
  EXPECT_EQ(drain(line), expected);
  web.offer(2, packet);
  expected = "\x82\x40";
  expected += packet_bytes(2, 0x01020304);
  EXPECT_EQ(drain(web), expected);
}

// Who leaves a producer and comes back to it is given its latest packet: perhaps one that it has had.
TEST_F(OutboxTest, SendsNoPacketTwice) {
  const auto pool = std::make_shared<PacketPool>();
  const auto packet = [&pool](std::uint64_t source, std::uint32_t sequence) {
    const auto made = pool->take();
    made->source = source;
    made->header.sequence = sequence;
    return made;
  };
  web.offer(1, packet(7, 3));
  EXPECT_FALSE(drain(web).empty());
  web.offer(1, packet(7, 3));
  EXPECT_TRUE(drain(web).empty());
  web.offer(1, packet(7, 4));
  EXPECT_FALSE(drain(web).empty());
  web.offer(1, packet(8, 0));
  EXPECT_FALSE(drain(web).empty()) << "another producer's";
  web.offer(1, packet(7, 4));
  EXPECT_FALSE(drain(web).empty()) << "it has seen something else since";
}

// After months of packets the numbers start again; the stream goes on.
TEST_F(OutboxTest, GoesOnWhereTheSequenceStartsAgain) {
  const auto pool = std::make_shared<PacketPool>();
  for (const std::uint32_t sequence : {0xFFFFFFFEU, 0xFFFFFFFFU, 0U, 1U}) {
    const auto packet = pool->take();
    packet->source = 1;
    packet->header.sequence = sequence;
    web.offer(1, packet);
    EXPECT_FALSE(drain(web).empty()) << sequence;
  }
}

TEST_F(OutboxTest, LargePacketsHaveTheLengthsOfTheStandardToo) {
  const auto pool = std::make_shared<PacketPool>();
  // 40 + 4 n bytes: the last of 7 bits, the first and last of 16, the first of 64.
  std::uint32_t sequence = 0;
  for (const std::size_t floats : {20U, 21U, 22U, 16373U, 16374U, 16375U}) {
    const auto packet = pool->take();
    packet->header.sequence = sequence++;
    packet->payload.resize_floats(floats);
    packet->source = 1;
    packet->header.payload_bytes = static_cast<std::uint32_t>(4 * floats);
    const std::size_t size = 40 + 4 * floats;
    std::string expected = size < 126 ? "" : size <= 65535 ? "\x7E" : "\x7F";
    if (size < 126) expected += static_cast<char>(size);
    for (int i = size < 126 ? -1 : size <= 65535 ? 1 : 7; i >= 0; --i) {
      expected += static_cast<char>(static_cast<unsigned char>(size >> (8U * static_cast<unsigned>(i))));
    }
    web.offer(1, packet);
    const std::string wire = drain(web);
    EXPECT_EQ(wire[0], '\x82');
    EXPECT_EQ(wire.substr(1, expected.size()), expected) << size;
    EXPECT_EQ(wire.size(), 1 + expected.size() + size);
  }
}

TEST_F(OutboxTest, ManyReadersShareOnePayload) {
  Outbox other(Framing::WebSocket, metrics);
  const PacketPtr packet = make_packet(0);
  line.offer(1, packet);
  other.offer(9, packet);
  const auto mine = line.take();
  const auto theirs = other.take();
  EXPECT_EQ(mine[1].data(), theirs[1].data());
  EXPECT_EQ(mine[1].data(), packet->payload.bytes().data());
  EXPECT_NE(std::memcmp(mine[0].data(), theirs[0].data(), 8), 0) << "headers are each reader's own";
}

TEST_F(OutboxTest, APacketThatIsBeingWrittenIsNotReplaced) {
  line.offer(1, make_packet(0));
  const std::string first = bytes_of(line);
  line.offer(1, make_packet(1));
  EXPECT_EQ(metrics.packets_skipped_total.load(), 0);
  line.written();
  EXPECT_EQ(header_in(first).sequence, 0U);
  EXPECT_EQ(header_in(drain(line)).sequence, 1U);
}

TEST_F(OutboxTest, ADiscontinuityIsCarriedOnce) {
  line.offer(1, make_packet(0, protocol::kFlagKey | protocol::kFlagDiscontinuity));
  line.offer(1, make_packet(1));
  EXPECT_EQ(header_in(drain(line)).flags, protocol::kFlagKey | protocol::kFlagDiscontinuity);
  line.offer(1, make_packet(2));
  EXPECT_EQ(header_in(drain(line)).flags, protocol::kFlagKey);
}

TEST_F(OutboxTest, ReplacingKeepsTheTurnOfTheStream) {
  line.offer(1, make_packet(0));
  line.offer(2, make_packet(0));
  line.offer(1, make_packet(5));  // stream 1 has waited longer and still goes first
  const std::string wire = drain(line);
  EXPECT_LT(wire.find("\"stream\":1,"), wire.find("\"stream\":2,"));
}

TEST_F(OutboxTest, EachStreamHasItsOwnNumbers) {
  line.offer(1, make_packet(7, protocol::kFlagKey, 5));
  static_cast<void>(drain(line));
  line.offer(2, make_packet(3, protocol::kFlagKey, 6));
  EXPECT_EQ(header_in(drain(line)).sequence, 3U);
  line.forget_stream(1);
  line.offer(1, make_packet(100, protocol::kFlagKey, 6));
  EXPECT_EQ(header_in(drain(line)).sequence, 100U) << "a forgotten stream has no history";
}

TEST_F(OutboxTest, NumbersGoOnOverSkippedProducersAndTheEndOfTheRange) {
  line.offer(1, make_packet(0xFFFFFFFFU, protocol::kFlagKey, 5));
  EXPECT_EQ(header_in(drain(line)).sequence, 0xFFFFFFFFU);
  line.offer(1, make_packet(9, protocol::kFlagKey, 6));  // replaced before it is sent
  line.offer(1, make_packet(20, protocol::kFlagKey, 7));
  EXPECT_EQ(header_in(drain(line)).sequence, 0U);
  line.offer(1, make_packet(22, protocol::kFlagKey, 7));
  EXPECT_EQ(header_in(drain(line)).sequence, 2U);
}

TEST_F(OutboxTest, AWriteTakesPacketsInThePlaceThatAnswersLeave) {
  for (int i = 0; i < 30; ++i) line.push_text("x");
  for (std::uint32_t stream = 1; stream <= 10; ++stream) line.offer(stream, make_packet(0));
  EXPECT_EQ(line.take().size(), 30U * 2U + 2U * 2U);  // text and its end; framing and payload
  line.written();
  line.push_text("late");
  const std::string wire = drain(line);
  EXPECT_EQ(wire.substr(0, 5), "late\n");
  EXPECT_NE(wire.find("\"stream\":10,"), std::string::npos);
  EXPECT_EQ(metrics.packets_sent_total.load(), 10);
  EXPECT_TRUE(line.empty());
}

TEST_F(OutboxTest, IsNotEmptyWhileSomethingIsBeingWritten) {
  line.push_text("x");
  static_cast<void>(line.take());
  EXPECT_FALSE(line.empty());
  line.written();
  EXPECT_TRUE(line.empty());
}

TEST_F(OutboxTest, PacketsCongestNothing) {
  const auto pool = std::make_shared<PacketPool>();
  const auto packet = pool->take();
  packet->header.payload_bytes =
      static_cast<std::uint32_t>(packet->payload.resize_floats(Outbox::kOverflowBytes / 2).size_bytes());
  line.offer(1, packet);
  EXPECT_FALSE(line.congested());
  EXPECT_FALSE(line.overflowed());
}

}  // namespace
}  // namespace tweend::net
