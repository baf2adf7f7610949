#pragma once

#include <sys/uio.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "server/base/metrics.hpp"
#include "server/net/data_lane.hpp"
#include "server/net/framing.hpp"

namespace tweend::net {

/// The messages of one gathered write: large, and so on the stack of whoever writes, where it is warm for all connections.
class Gathered {
 public:
  static constexpr std::size_t kMostMessages = 32;

  /// For sendmsg(). Valid until the outbox changes.
  [[nodiscard]] std::span<iovec> buffers() noexcept { return {buffers_.data(), buffer_count_}; }
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
  [[nodiscard]] std::size_t messages() const noexcept { return message_count_; }

 private:
  friend class Outbox;
  struct Message {
    std::size_t bytes;
    bool data;  ///< else of the control lane
  };
  [[nodiscard]] bool full() const noexcept { return message_count_ == kMostMessages; }
  void begin_message(bool data, std::size_t skipped) noexcept;
  void add(const void* bytes, std::size_t size) noexcept;

  // Not initialised: only the first so many of each are meant.
  std::array<iovec, 3 * kMostMessages> buffers_;
  std::array<Message, kMostMessages> all_;
  std::array<std::array<char, kMostPrefixBytes>, kMostMessages> prefixes_;
  std::size_t buffer_count_ = 0;
  std::size_t message_count_ = 0;
  std::size_t bytes_ = 0;
  std::size_t skip_ = 0;  ///< bytes that were written before, of the message in the making
};

/// What waits to be written to one client, in two lanes: answers and notifications first, then packets (DataLane). A message
/// leaves its lane with its last byte: until its first one, whatever is more urgent or newer goes ahead of it or takes its
/// place. Payloads are shared with all other readers; nothing is copied but a few bytes of framing, made anew for each write.
/// Network thread only.
///
/// The control lane is bounded by its owner, who starts nothing more above kCongestedBytes and closes above kOverflowBytes; the
/// data lane as data_lane.hpp says: 8 packets and 8 MiB a stream of the newest only (or one packet, whatever its size), 16 MiB
/// of all streams of which every packet is wanted, each packet counted as at least 4 KiB.
class Outbox {
 public:
  /// Above this, the conversation starts nothing more until the client has read.
  static constexpr std::size_t kCongestedBytes = 1U << 20U;
  /// Above this, a client that asked for events and does not read them is cut off.
  static constexpr std::size_t kOverflowBytes = 8U << 20U;

  Outbox(Framing framing, Metrics& metrics) : framing_(framing), metrics_(metrics), data_(metrics) {}

  void push_text(std::string text);
  void push_shared(std::shared_ptr<const std::string> text);
  /// Behind the packets that wait already.
  void push_after_packets(std::shared_ptr<const std::string> text);
  /// Bytes that are framed already (Beast's handshake and pongs), as one unit.
  void push_raw(std::string bytes);
  /// The last word, framed already or empty: what waits in the control lane goes before it, packets are dropped, and nothing
  /// is taken any more.
  void push_last(std::string bytes);
  [[nodiscard]] bool last_said() const noexcept { return last_said_; }

  /// The streams and their packets.
  [[nodiscard]] DataLane& data() noexcept { return data_; }
  [[nodiscard]] const DataLane& data() const noexcept { return data_; }
  /// No more packets are sent, but for the rest of one that has begun. Words about them join the answers.
  void drop_data();

  /// What is to be written next, in its order; nothing moves yet.
  /// @param out  fresh
  void gather(Gathered& out) const noexcept;
  /// So many bytes of what was gathered have been written; nothing has changed in between.
  /// @param now_us  clock reading; only adaptive streams ask for it
  void wrote(const Gathered& gathered, std::size_t bytes, std::int64_t now_us = 0);

  [[nodiscard]] bool empty() const noexcept { return control_.empty() && data_.size() == 0; }
  [[nodiscard]] bool congested() const noexcept { return control_bytes_ > kCongestedBytes; }
  [[nodiscard]] bool overflowed() const noexcept { return event_bytes_ > kOverflowBytes; }

 private:
  struct Control {
    std::string text;
    std::shared_ptr<const std::string> shared;  ///< instead of the text: a notification
    bool raw = false;

    [[nodiscard]] const std::string& body() const noexcept { return shared ? *shared : text; }
    /// What it counts for. Pongs of two bytes take many times as much.
    [[nodiscard]] std::size_t cost() const noexcept { return body().size() + (raw ? sizeof(Control) : 0); }
  };
  enum class Begun : std::uint8_t { None, Control, Data };

  void push_control(Control item);
  void gather_control(const Control& item, Gathered& out) const noexcept;
  void gather_data(const DataLane::Entry& entry, bool alone, Gathered& out) const noexcept;
  void gather_text(const std::string& body, bool raw, Gathered& out) const noexcept;
  void pop_control();
  void pop_data(std::int64_t now_us);

  const Framing framing_;
  Metrics& metrics_;
  std::deque<Control> control_;
  DataLane data_;
  bool last_said_ = false;
  Begun begun_ = Begun::None;      ///< the lane whose first message is partly written
  std::size_t begun_bytes_ = 0;    ///< of it
  std::size_t control_bytes_ = 0;  ///< waiting or being written, words about packets included
  std::size_t event_bytes_ = 0;    ///< notifications among them, which the client can't hold back
};

}  // namespace tweend::net
