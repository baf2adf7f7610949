#include "server/net/outbox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "tests/net/made_packets.hpp"

namespace tweend::net {
namespace {

using streams::PacketPtr;
using test::make_packet;

/// What one gathered write takes, at most so much of it.
std::string write_some(Outbox& outbox, std::size_t most = std::string::npos) {
  Gathered gathered;
  outbox.gather(gathered);
  std::string all;
  for (const iovec& b : gathered.buffers()) all.append(static_cast<const char*>(b.iov_base), b.iov_len);
  EXPECT_EQ(all.size(), gathered.bytes());
  all.resize(std::min(all.size(), most));
  outbox.wrote(gathered, all.size());
  return all;
}

std::string drain(Outbox& outbox) {
  std::string all;
  for (std::string some = write_some(outbox); !some.empty(); some = write_some(outbox)) all += some;
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
  line.data().offer(7, make_packet(3), 0);
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
  web.data().offer(1, make_packet(0), 0);
  const std::string wire = drain(web);
  EXPECT_EQ(wire.substr(0, 2), std::string("\x82\x40", 2));
  EXPECT_EQ(wire.size(), 2U + 64U);
}

TEST_F(OutboxTest, StreamsDoNotReplaceEachOther) {
  line.data().offer(1, make_packet(0), 0);
  line.data().offer(2, make_packet(0), 0);
  EXPECT_EQ(metrics.packets_skipped_total.load(), 0);
  const std::string wire = drain(line);
  EXPECT_NE(wire.find("\"stream\":1,"), std::string::npos);
  EXPECT_NE(wire.find("\"stream\":2,"), std::string::npos);
}

TEST_F(OutboxTest, AnswersGoBeforePackets) {
  line.data().offer(1, make_packet(0), 0);
  line.push_text("answer");
  EXPECT_EQ(drain(line).substr(0, 7), "answer\n");
}

TEST_F(OutboxTest, AWordAboutPacketsStaysBehindThem) {
  line.data().offer(1, make_packet(0), 0);
  line.push_after_packets(std::make_shared<const std::string>("ended"));
  line.push_text("answer");
  line.data().offer(1, make_packet(1), 0);  // replaces the waiting one, still before the word
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
  line.data().offer(1, make_packet(0), 0);
  line.data().forget(1);
  EXPECT_TRUE(line.empty());
  EXPECT_EQ(drain(line), "");
}

TEST_F(OutboxTest, PayloadsAreSharedAndNeverCopied) {
  const PacketPtr packet = make_packet(0);
  line.data().offer(1, packet, 0);
  Gathered alone;
  line.gather(alone);
  ASSERT_EQ(alone.buffers().size(), 1U) << "its framing stands right before it";
  const auto* const end = static_cast<const std::byte*>(alone.buffers()[0].iov_base) + alone.buffers()[0].iov_len;
  EXPECT_EQ(end, packet->payload.bytes().data() + packet->payload.bytes().size());
  line.data().offer(2, packet, 0);
  Gathered both;
  line.gather(both);
  ASSERT_EQ(both.buffers().size(), 4U) << "one packet of two streams has two framings";
  EXPECT_EQ(both.buffers()[1].iov_base, packet->payload.bytes().data());
  EXPECT_EQ(both.buffers()[3].iov_base, packet->payload.bytes().data());
}

TEST_F(OutboxTest, AWriteGathersAtMostThirtyTwoMessages) {
  for (int i = 0; i < 40; ++i) line.push_text("x");
  EXPECT_EQ(write_some(line).size(), 64U);
  EXPECT_EQ(write_some(line).size(), 16U);
}

TEST_F(OutboxTest, UnreadAnswersCongestAndAreRelievedByWriting) {
  line.push_text(std::string(Outbox::kCongestedBytes, 'x'));
  EXPECT_FALSE(line.congested());
  line.push_text("y");
  EXPECT_TRUE(line.congested());
  static_cast<void>(write_some(line, Outbox::kCongestedBytes));
  EXPECT_TRUE(line.congested()) << "what is being written has not been taken yet";
  static_cast<void>(write_some(line, 1));
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
  const PacketPtr packet = make_packet({.sequence = 0x01020304, .server_us = 0});
  line.data().offer(4000000000U, packet, 0);
  std::string expected = R"({"jsonrpc":"2.0","method":"stream.packet","params":{"stream":4000000000,"bytes":64}})";
  expected += '\n';
  expected += packet_bytes(4000000000U, 0x01020304);
  EXPECT_EQ(drain(line), expected);
  web.data().offer(2, packet, 0);
  expected = "\x82\x40";
  expected += packet_bytes(2, 0x01020304);
  EXPECT_EQ(drain(web), expected);
}

TEST_F(OutboxTest, LargePacketsHaveTheLengthsOfTheStandardToo) {
  // 40 + 4 n bytes: the last of 7 bits, the first and last of 16, the first of 64.
  std::uint32_t sequence = 0;
  for (const std::size_t floats : {20U, 21U, 22U, 16373U, 16374U, 16375U}) {
    const std::size_t size = 40 + 4 * floats;
    std::string expected = size < 126 ? "" : size <= 65535 ? "\x7E" : "\x7F";
    if (size < 126) expected += static_cast<char>(size);
    for (int i = size < 126 ? -1 : size <= 65535 ? 1 : 7; i >= 0; --i) {
      expected += static_cast<char>(static_cast<unsigned char>(size >> (8U * static_cast<unsigned>(i))));
    }
    web.data().offer(1, make_packet({.sequence = sequence++, .floats = floats}), 0);
    const std::string wire = drain(web);
    EXPECT_EQ(wire[0], '\x82');
    EXPECT_EQ(wire.substr(1, expected.size()), expected) << size;
    EXPECT_EQ(wire.size(), 1 + expected.size() + size);
  }
}

TEST_F(OutboxTest, ManyReadersShareOnePayload) {
  Outbox other(Framing::WebSocket, metrics);
  const PacketPtr packet = make_packet(0);
  line.data().offer(1, packet, 0);
  other.data().offer(9, packet, 0);
  // One after the other, as the thread that writes does it.
  Gathered mine, theirs;
  line.gather(mine);
  const std::string first(static_cast<const char*>(mine.buffers()[0].iov_base), mine.buffers()[0].iov_len);
  other.gather(theirs);
  const std::string second(static_cast<const char*>(theirs.buffers()[0].iov_base), theirs.buffers()[0].iov_len);
  const auto end_of = [](Gathered& g) { return static_cast<const char*>(g.buffers()[0].iov_base) + g.buffers()[0].iov_len; };
  EXPECT_EQ(end_of(mine), end_of(theirs));
  EXPECT_NE(first.substr(0, 8), second.substr(0, 8)) << "headers are each reader's own";
}

TEST_F(OutboxTest, AWriteTakesPacketsInThePlaceThatAnswersLeave) {
  for (int i = 0; i < 30; ++i) line.push_text("x");
  for (std::uint32_t stream = 1; stream <= 10; ++stream) line.data().offer(stream, make_packet(0), 0);
  Gathered gathered;
  line.gather(gathered);
  EXPECT_EQ(gathered.messages(), 32U);
  EXPECT_EQ(gathered.buffers().size(), 30U * 2U + 2U * 2U);  // text and its end; framing and payload
  static_cast<void>(write_some(line));
  line.push_text("late");
  const std::string wire = drain(line);
  EXPECT_EQ(wire.substr(0, 5), "late\n");
  EXPECT_NE(wire.find("\"stream\":10,"), std::string::npos);
  EXPECT_EQ(metrics.packets_sent_total.load(), 10);
  EXPECT_TRUE(line.empty());
}

TEST_F(OutboxTest, IsNotEmptyWhileSomethingIsBeingWritten) {
  line.push_text("x");
  static_cast<void>(write_some(line, 1));
  EXPECT_FALSE(line.empty());
  EXPECT_EQ(write_some(line), "\n");
  EXPECT_TRUE(line.empty());
}

TEST_F(OutboxTest, PacketsCongestNothing) {
  line.data().offer(1, make_packet({.floats = Outbox::kOverflowBytes / 2}), 0);
  EXPECT_FALSE(line.congested());
  EXPECT_FALSE(line.overflowed());
}

/// Cuts a connection's bytes into messages by the documents alone: a line, a line with the bytes that it announces, a frame.
std::vector<std::string> messages_in(Framing framing, const std::string& wire) {
  std::vector<std::string> messages;
  for (std::size_t at = 0; at < wire.size();) {
    std::size_t end = 0;
    if (framing == Framing::Line) {
      end = wire.find('\n', at) + 1;
      const std::string key = "\"bytes\":";
      const std::size_t bytes = wire.substr(at, end - at).find(key);
      if (bytes != std::string::npos) end += std::stoul(wire.substr(at + bytes + key.size()));
    } else {
      const auto size = static_cast<unsigned char>(wire.at(at + 1));
      const auto byte = [&](std::size_t i) { return std::size_t{static_cast<unsigned char>(wire.at(at + i))}; };
      end = at + (size < 126 ? 2U + size : 4U + byte(2) * 256 + byte(3));
    }
    if (end <= at || end > wire.size()) {
      ADD_FAILURE() << "a message that is none at " << at;
      break;
    }
    messages.push_back(wire.substr(at, end - at));
    at = end;
  }
  return messages;
}

// The socket takes so many bytes and then more; something urgent comes in between.
TEST_F(OutboxTest, WritesGoOnExactlyWhereTheyStoppedAndNothingFallsInsideAPacket) {
  for (const Framing framing : {Framing::Line, Framing::WebSocket}) {
    const auto fill = [](Outbox& outbox) {
      outbox.push_text("first");
      outbox.push_shared(std::make_shared<const std::string>("second"));
      outbox.data().offer(1, make_packet({.server_us = 0}), 0);
      outbox.data().offer(2, make_packet({.server_us = 0, .floats = 30}), 0);
      outbox.push_after_packets(std::make_shared<const std::string>("after"));
    };
    Outbox whole(framing, metrics);
    fill(whole);
    const std::string expected = drain(whole);
    auto urgent_first = messages_in(framing, expected);
    ASSERT_EQ(urgent_first.size(), 5U);
    for (std::size_t split = 1; split < expected.size(); ++split) {
      Outbox outbox(framing, metrics);
      fill(outbox);
      std::string wire = write_some(outbox, split);
      outbox.push_text("urgent");
      for (std::string more = write_some(outbox, 3); !more.empty(); more = write_some(outbox, 3)) wire += more;
      auto messages = messages_in(framing, wire);
      const auto urgent = std::find_if(messages.begin(), messages.end(),
                                       [](const std::string& m) { return m.find("urgent") != std::string::npos; });
      ASSERT_NE(urgent, messages.end()) << split;
      // Behind what had begun, and behind answers that came before it; never behind a packet that had not.
      std::size_t begun = 0;
      for (std::size_t bytes = 0; bytes < split; ++begun) bytes += urgent_first[begun].size();
      ASSERT_EQ(static_cast<std::size_t>(urgent - messages.begin()), std::max<std::size_t>(begun, 2)) << split;
      messages.erase(urgent);
      ASSERT_EQ(messages, urgent_first) << split;
      ASSERT_TRUE(outbox.empty());
    }
  }
}

TEST_F(OutboxTest, FramesOfTwoBytesCountForTheMemoryTheyTake) {
  // A text and who shares it, at least.
  const std::size_t most = Outbox::kCongestedBytes / (sizeof(std::string) + sizeof(std::shared_ptr<std::string>));
  std::size_t pongs = 0;
  for (; !web.congested() && pongs <= most; ++pongs) web.push_raw(std::string("\x8A\0", 2));
  EXPECT_LE(pongs, most);
  EXPECT_EQ(drain(web).size(), 2 * pongs);
  EXPECT_FALSE(web.congested());
}

TEST_F(OutboxTest, NothingIsTakenAfterTheLastWord) {
  for (std::uint32_t stream = 1; stream <= 2; ++stream) web.data().offer(stream, make_packet(0), 0);
  web.push_after_packets(std::make_shared<const std::string>("ended"));
  std::string wire = write_some(web, 10);
  web.push_text("answer");
  EXPECT_FALSE(web.last_said());
  web.push_last(close_frame(1001, "going"));
  EXPECT_TRUE(web.last_said());
  web.push_last(close_frame(1000, {}));
  web.push_text("late");
  web.push_shared(std::make_shared<const std::string>("late"));
  web.push_after_packets(std::make_shared<const std::string>("late"));
  web.push_raw("late");
  wire += drain(web);
  const auto messages = messages_in(Framing::WebSocket, wire);
  ASSERT_EQ(messages.size(), 4U);
  EXPECT_EQ(messages[0].size(), 2U + 64U) << "what had begun";
  EXPECT_EQ(messages[1],
            "\x81\x06"
            "answer");
  EXPECT_EQ(messages[2],
            "\x81\x05"
            "ended");
  EXPECT_EQ(messages[3],
            "\x88\x07\x03\xE9"
            "going");
  EXPECT_TRUE(web.empty());
}

TEST_F(OutboxTest, WhatIsDroppedLeavesWhatHasBegunAndAllWords) {
  for (std::uint32_t stream = 1; stream <= 3; ++stream) line.data().offer(stream, make_packet(0), 0);
  line.push_after_packets(std::make_shared<const std::string>(std::string(Outbox::kOverflowBytes + 1, 'x')));
  EXPECT_TRUE(line.overflowed());
  std::string wire = write_some(line, 10);
  line.push_text("answer");
  line.drop_data();
  EXPECT_TRUE(line.overflowed());
  wire += drain(line);
  EXPECT_FALSE(line.overflowed());
  EXPECT_FALSE(line.congested());
  const auto messages = messages_in(Framing::Line, wire);
  ASSERT_EQ(messages.size(), 3U);
  EXPECT_EQ(header_in(messages[0]).stream, 1U);
  EXPECT_EQ(messages[1], "answer\n");
  EXPECT_EQ(messages[2].size(), Outbox::kOverflowBytes + 2);
}

}  // namespace
}  // namespace tweend::net
