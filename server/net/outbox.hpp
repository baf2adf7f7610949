#pragma once

#include <array>
#include <boost/asio/buffer.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/base/metrics.hpp"
#include "server/streams/packet.hpp"

namespace tweend::net {

/// How messages and packets are delimited on a connection.
enum class Framing : std::uint8_t {
  Line,       ///< text and '\n'; a packet behind the line that announces it
  WebSocket,  ///< RFC 6455 frames, unmasked: text messages and binary packets
  Multipart,  ///< RFC 2046 parts of an HTTP answer, one a picture; there is no place for messages, which are dropped
};

/// What stands between the parts of a Multipart answer.
#define TWEEND_BOUNDARY "tweend-frame"
inline constexpr std::string_view kMultipartType = "multipart/x-mixed-replace; boundary=" TWEEND_BOUNDARY;
inline constexpr std::string_view kMultipartBegin = "--" TWEEND_BOUNDARY "\r\n";
inline constexpr std::string_view kMultipartNext = "\r\n--" TWEEND_BOUNDARY "\r\n";
#undef TWEEND_BOUNDARY

/// What waits to be written to one client, in two lanes: answers and notifications first, then packets. A packet that is
/// still waiting when a newer one of its stream comes is replaced by it, so that a slow reader skips and never falls behind.
/// Payloads are shared with all other readers; nothing is copied but a few bytes of framing. Network thread only.
class Outbox {
 public:
  /// Above this, the conversation starts nothing more until the client has read.
  static constexpr std::size_t kCongestedBytes = 1U << 20U;
  /// Above this, a client that asked for events and does not read them is cut off.
  static constexpr std::size_t kOverflowBytes = 8U << 20U;

  Outbox(Framing framing, Metrics& metrics) : framing_(framing), metrics_(metrics) {}

  void push_text(std::string text);
  void push_shared(std::shared_ptr<const std::string> text);
  /// Behind the packets that wait already.
  void push_after_packets(std::shared_ptr<const std::string> text);
  /// Bytes that are framed already (Beast's handshake, pongs, closes), as one unit.
  void push_raw(std::string bytes);
  void offer(std::uint32_t stream, const streams::PacketPtr& packet);
  void forget_stream(std::uint32_t stream);

  /// Moves the next messages to the write under way and returns their bytes; empty: nothing waits.
  /// The buffers stay valid until written(). Precondition: no write is under way.
  [[nodiscard]] std::span<const boost::asio::const_buffer> take();
  void written();

  [[nodiscard]] bool empty() const noexcept { return control_.empty() && data_.empty() && writing_.empty(); }
  [[nodiscard]] bool congested() const noexcept { return control_bytes_ > kCongestedBytes; }
  [[nodiscard]] bool overflowed() const noexcept { return event_bytes_ > kOverflowBytes; }

 private:
  /// One message: framing, then the body that is set.
  struct Item {
    std::array<char, 176> prefix;
    std::size_t prefix_size = 0;
    std::string text;
    std::shared_ptr<const std::string> shared;
    streams::PacketPtr packet;
    std::uint32_t stream = 0;
    std::uint8_t carried_flags = 0;  ///< of packets that this one has replaced
    std::string_view suffix;         ///< of static storage
    bool event = false;

    [[nodiscard]] std::size_t body_bytes() const noexcept;
  };
  /// Numbering of one stream across its producers.
  struct StreamNumbers {
    std::uint64_t source = 0;
    std::uint32_t base = 0;
    std::uint32_t last = 0;
  };

  void frame_text(Item& item) const;
  void frame_packet(Item& item);
  static void frame_part(Item& item);
  void push_control(Item item);
  void add_buffers(const Item& item);

  const Framing framing_;
  Metrics& metrics_;
  std::deque<Item> control_;
  std::vector<Item> data_;  ///< at most one packet a stream: short, and its memory is kept
  std::vector<Item> writing_;
  std::vector<boost::asio::const_buffer> buffers_;
  std::map<std::uint32_t, StreamNumbers> numbers_;
  std::size_t control_bytes_ = 0;  ///< waiting or being written
  std::size_t event_bytes_ = 0;    ///< notifications among them, which the client can't hold back
};

}  // namespace tweend::net
