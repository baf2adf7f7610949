#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/base/metrics.hpp"
#include "server/commands/peer.hpp"
#include "server/net/rung_controller.hpp"
#include "server/streams/packet.hpp"

namespace tweend::net {

/// The packets that wait to be written to one client, of all its streams in the order in which they came.
///
/// What waits is bounded. Of a stream of the newest only (the default) it is a chain: a key and what needs it, at most
/// kChainPackets and kChainBytes. A newer key takes the place of the whole chain; where the chain would grow longer, it is
/// dropped and the stream waits for its next key. So a slow reader skips, sees the gap in the numbers, and never falls behind.
/// Of streams of which every packet is wanted, kEveryBytes may wait together; then behind() names one.
/// One thread; takes no memory for a packet once it has grown to its size.
class DataLane {
 public:
  static constexpr std::size_t kChainPackets = 8;
  static constexpr std::size_t kChainBytes = std::size_t{8} << 20U;  ///< or a single packet
  static constexpr std::size_t kEveryBytes = std::size_t{16} << 20U;
  /// Counted for each packet beside its payload, so that there is a bound to small ones, too.
  static constexpr std::size_t kPacketOverhead = 512;

  /// What waits for its turn: a packet, or a word about packets that must not overtake them.
  struct Entry {
    streams::PacketPtr packet;
    std::shared_ptr<const std::string> word;  ///< where there is no packet
    std::int64_t offered_us = 0;
    std::uint32_t stream = 0;
    std::uint32_t sequence = 0;  ///< as this client counts
    std::uint8_t flags = 0;      ///< the packet's, and those of what was skipped before it
    bool every = false;
    bool counted = false;  ///< among those that wait, by the meter
  };
  struct RungMove {
    std::uint32_t stream;
    std::size_t rung;
  };

  explicit DataLane(Metrics& metrics) : metrics_(metrics) {}
  ~DataLane() { drop(0); }  // what waits is counted
  DataLane(const DataLane&) = delete;
  DataLane& operator=(const DataLane&) = delete;

  void expect(std::uint32_t stream, commands::StreamPolicy policy);
  [[nodiscard]] bool knows(std::uint32_t stream) const noexcept { return find(stream) != streams_.end(); }
  /// @param now_us  clock reading; only adaptive streams ask for it
  void offer(std::uint32_t stream, const streams::PacketPtr& packet, std::int64_t now_us);
  void push_word(std::shared_ptr<const std::string> word);
  /// Nothing more comes of this stream; what waits is still sent.
  void end(std::uint32_t stream);
  /// Nothing more is sent of this stream, but for the rest of a packet that has begun.
  void forget(std::uint32_t stream);
  /// Drops all that has not begun.
  void drop_waiting() { drop(first_waiting()); }

  [[nodiscard]] std::size_t size() const noexcept { return entries_.size() - first_; }
  [[nodiscard]] const Entry& operator[](std::size_t index) const noexcept { return entries_[first_ + index]; }
  /// The first entry is on its way: nothing takes its place any more.
  void begin_front() noexcept;
  /// The first entry has been written; a packet is counted as sent.
  void pop_front(std::int64_t now_us);

  /// What is here now has to wait: the meters count it. What leaves at once never was in anybody's queue.
  void settle_in() noexcept;

  /// A stream of which every packet is wanted, where more waits than may.
  [[nodiscard]] std::optional<std::uint32_t> behind() const noexcept;
  /// Of such streams, what waits, each packet with its overhead.
  [[nodiscard]] std::size_t every_bytes() const noexcept { return every_bytes_; }
  [[nodiscard]] bool adaptive() const noexcept { return adaptive_; }
  /// The next adaptive stream that is to move, each move once.
  [[nodiscard]] std::optional<RungMove> next_move();

 private:
  struct Stream {
    std::uint32_t number = 0;
    commands::StreamPolicy policy;
    bool heard = false;      ///< a packet was offered
    bool taken = false;      ///< a packet has waited here
    bool needs_key = true;   ///< the next packets' predecessor is not to be had
    std::uint8_t flags = 0;  ///< of skipped packets, for the next that is not
    std::uint32_t base = 0;  ///< from the producer's numbers to this client's
    std::uint32_t offered = 0;
    std::uint64_t source = 0;  ///< the producer
    std::int64_t server_us = 0;
    std::size_t waiting = 0;
    std::size_t waiting_bytes = 0;
    std::unique_ptr<RungController> rungs;
    std::size_t rung = 0;  ///< where it has been told to be
  };
  using Streams = std::vector<Stream>;

  [[nodiscard]] Entry& at(std::size_t index) noexcept { return entries_[first_ + index]; }
  [[nodiscard]] std::size_t first_waiting() const noexcept { return front_begun_ ? 1 : 0; }
  [[nodiscard]] Streams::const_iterator find(std::uint32_t stream) const noexcept;
  [[nodiscard]] Stream* find(std::uint32_t stream) noexcept;
  [[nodiscard]] bool number(Stream& stream, const streams::Packet& packet);
  void append(Stream& stream, const streams::PacketPtr& packet, std::int64_t now_us);
  void skip(Stream& stream, const streams::Packet& packet);
  void drop_chain(Stream& stream, std::int64_t now_us);
  void replace(Stream& stream, const streams::PacketPtr& packet, std::int64_t now_us);
  void waits_no_more(const Entry& entry) noexcept;
  void take_out(std::size_t index) noexcept;
  void drop(std::size_t from) noexcept;
  void notice_rung(Stream& stream) noexcept { moves_ = moves_ || stream.rungs->rung() != stream.rung; }

  Metrics& metrics_;
  std::vector<Entry> entries_;  ///< those before first_ are empty; a lane that runs empty begins anew, where its memory is warm
  std::size_t first_ = 0;
  Streams streams_;  ///< by number; few, and so flat
  std::size_t every_bytes_ = 0;
  bool front_begun_ = false;
  bool adaptive_ = false;  ///< one of the streams is
  bool moves_ = false;
};

}  // namespace tweend::net
