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
  const auto packet = pool->take(6);
  for (std::size_t i = 0; i < 6; ++i) packet->payload[i] = static_cast<float>(i);
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
  EXPECT_EQ(buffers[1].data(), packet->payload.data());
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

}  // namespace
}  // namespace tweend::net
