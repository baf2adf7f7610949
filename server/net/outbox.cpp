#include "server/net/outbox.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace tweend::net {
namespace {

constexpr std::size_t kMessagesAtOnce = 32;

constexpr unsigned char kTextFrame = 0x81;    // FIN, opcode 1
constexpr unsigned char kBinaryFrame = 0x82;  // FIN, opcode 2

/// RFC 6455, section 5.2: an unmasked frame's header.
std::size_t write_frame_header(unsigned char first, std::size_t bytes, char* out) noexcept {
  out[0] = static_cast<char>(first);
  const std::size_t size_bytes = bytes < 126 ? 0 : bytes <= 0xFFFF ? 2 : 8;
  out[1] = static_cast<char>(size_bytes == 0 ? bytes : size_bytes == 2 ? 126 : 127);
  for (std::size_t i = 0; i < size_bytes; ++i) out[2 + i] = static_cast<char>((bytes >> (8 * (size_bytes - 1 - i))) & 0xFFU);
  return 2 + size_bytes;
}

}  // namespace

std::size_t Outbox::Item::body_bytes() const noexcept {
  return packet ? packet->payload.bytes().size() : shared ? shared->size() : text.size();
}

void Outbox::frame_text(Item& item) const {
  if (framing_ == Framing::Line) {
    item.suffix = "\n";
  } else {
    item.prefix_size = write_frame_header(kTextFrame, item.body_bytes(), item.prefix.data());
  }
}

void Outbox::frame_packet(Item& item) {
  protocol::PacketHeader header = item.packet->header;
  StreamNumbers& numbers = numbers_[item.stream];
  if (numbers.source != item.packet->source) {
    numbers.base = numbers.source == 0 ? 0 : numbers.last + 1 - header.sequence;
    numbers.source = item.packet->source;
  }
  header.stream = item.stream;
  header.sequence += numbers.base;
  header.flags = static_cast<std::uint8_t>(header.flags | item.carried_flags);
  numbers.last = header.sequence;

  if (framing_ == Framing::Multipart) return frame_part(item);
  const std::size_t bytes = protocol::kPacketHeaderBytes + header.payload_bytes;
  char* const begin = item.prefix.data();
  char* at = begin;
  if (framing_ == Framing::Line) {
    at = fmt::format_to(at,
                        R"({{"jsonrpc":"2.0","method":"stream.packet","params":{{"stream":{},"bytes":{}}}}})"
                        "\n",
                        item.stream, bytes);
  } else {
    at += write_frame_header(kBinaryFrame, bytes, at);
  }
  const protocol::PacketHeaderBytes encoded = protocol::encode_header(header);
  std::memcpy(at, encoded.data(), encoded.size());
  item.prefix_size = static_cast<std::size_t>(at - begin) + encoded.size();
}

/// The boundary stands behind each part, not before: a browser shows a picture when it sees the next boundary.
void Outbox::frame_part(Item& item) {
  const char* const end = fmt::format_to(item.prefix.data(), "Content-Type: image/jpeg\r\nContent-Length: {}\r\n\r\n",
                                         item.packet->header.payload_bytes);
  item.prefix_size = static_cast<std::size_t>(end - item.prefix.data());
  item.suffix = kMultipartNext;
}

void Outbox::push_control(Item item) {
  control_bytes_ += item.body_bytes();
  if (item.event) event_bytes_ += item.body_bytes();
  control_.push_back(std::move(item));
}

void Outbox::push_text(std::string text) {
  if (framing_ == Framing::Multipart) return;
  Item item;
  item.text = std::move(text);
  frame_text(item);
  push_control(std::move(item));
}

void Outbox::push_shared(std::shared_ptr<const std::string> text) {
  if (framing_ == Framing::Multipart) return;
  Item item;
  item.shared = std::move(text);
  item.event = true;
  frame_text(item);
  push_control(std::move(item));
}

void Outbox::push_after_packets(std::shared_ptr<const std::string> text) {
  if (framing_ == Framing::Multipart) return;
  if (data_.empty()) return push_shared(std::move(text));
  Item item;
  item.shared = std::move(text);
  item.event = true;
  frame_text(item);
  control_bytes_ += item.body_bytes();
  event_bytes_ += item.body_bytes();
  data_.push_back(std::move(item));
}

void Outbox::push_raw(std::string bytes) {
  Item item;
  item.text = std::move(bytes);
  push_control(std::move(item));
}

void Outbox::offer(std::uint32_t stream, const streams::PacketPtr& packet) {
  // Who leaves a producer and comes back to it is given its latest packet, which it may have had.
  const auto had = numbers_.find(stream);
  if (had != numbers_.end() && had->second.source == packet->source) {
    // The difference, not the numbers: they start again from 0 after 2^32 packets.
    const auto ahead = static_cast<std::int32_t>(packet->header.sequence + had->second.base - had->second.last);
    if (ahead <= 0) return;
  }
  const auto waiting =
      std::find_if(data_.begin(), data_.end(), [stream](const Item& i) { return i.packet && i.stream == stream; });
  if (waiting == data_.end()) {
    Item& item = data_.emplace_back();
    item.stream = stream;
    item.packet = packet;
    return;
  }
  add(metrics_.packets_skipped_total);
  waiting->carried_flags =
      static_cast<std::uint8_t>(waiting->carried_flags | (waiting->packet->header.flags & protocol::kFlagDiscontinuity));
  waiting->packet = packet;
}

void Outbox::forget_stream(std::uint32_t stream) {
  std::erase_if(data_, [stream](const Item& i) { return i.packet && i.stream == stream; });
  numbers_.erase(stream);
}

void Outbox::add_buffers(const Item& item) {
  if (item.prefix_size > 0) buffers_.emplace_back(item.prefix.data(), item.prefix_size);
  if (item.packet) {
    const auto payload = item.packet->payload.bytes();
    buffers_.emplace_back(payload.data(), payload.size());
  } else {
    const std::string& text = item.shared ? *item.shared : item.text;
    buffers_.emplace_back(text.data(), text.size());
  }
  if (!item.suffix.empty()) buffers_.emplace_back(item.suffix.data(), item.suffix.size());
}

std::span<const boost::asio::const_buffer> Outbox::take() {
  buffers_.clear();
  while (!control_.empty() && writing_.size() < kMessagesAtOnce) {
    writing_.push_back(std::move(control_.front()));
    control_.pop_front();
  }
  const auto packets = static_cast<std::ptrdiff_t>(std::min(data_.size(), kMessagesAtOnce - writing_.size()));
  for (auto at = data_.begin(); at != data_.begin() + packets; ++at) {
    Item& item = writing_.emplace_back(std::move(*at));
    if (!item.packet) continue;
    frame_packet(item);
    add(metrics_.packets_sent_total);
  }
  data_.erase(data_.begin(), data_.begin() + packets);
  // Only now: the vector may have moved its items while it grew.
  for (const Item& item : writing_) add_buffers(item);
  return buffers_;
}

void Outbox::written() {
  for (const Item& item : writing_) {
    if (item.packet) continue;
    control_bytes_ -= item.body_bytes();
    if (item.event) event_bytes_ -= item.body_bytes();
  }
  writing_.clear();
}

}  // namespace tweend::net
