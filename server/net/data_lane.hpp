#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <list>
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
/// What becomes of a packet costs the same however many others wait. One thread; takes no memory for a packet once the lane
/// has grown to its size.
class DataLane {
 public:
  static constexpr std::size_t kChainPackets = 8;
  static constexpr std::size_t kChainBytes = std::size_t{8} << 20U;  ///< or a single packet
  static constexpr std::size_t kEveryBytes = std::size_t{16} << 20U;
  /// What a packet counts for at least, so that no more than kEveryBytes of these wait, however small they are.
  static constexpr std::size_t kLeastBytes = std::size_t{4} << 10U;

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
  ~DataLane();
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
  /// Drops all packets that have not begun. @return the words among them, in their order
  std::vector<std::shared_ptr<const std::string>> drop_waiting();

  [[nodiscard]] std::size_t size() const noexcept { return entries_.size(); }
  [[nodiscard]] const std::list<Entry>& entries() const noexcept { return entries_; }
  [[nodiscard]] const Entry& front() const noexcept { return entries_.front(); }
  /// The first entry is on its way: nothing takes its place any more.
  void begin_front() noexcept;
  /// The first entry has been written; a packet is counted as sent.
  void pop_front(std::int64_t now_us);

  /// What is here now has to wait: the meters count it. What leaves at once never was in anybody's queue.
  void settle_in() noexcept;

  /// Where more waits than may of streams of which every packet is wanted: the one of which most waits, of those that have not
  /// ended.
  [[nodiscard]] std::optional<std::uint32_t> behind() const noexcept;
  /// Of such streams, what waits, each packet with what it counts for.
  [[nodiscard]] std::size_t every_bytes() const noexcept { return every_bytes_; }
  [[nodiscard]] bool adaptive() const noexcept { return adaptive_; }
  /// The next adaptive stream that is to move, each move once.
  [[nodiscard]] std::optional<RungMove> next_move();

 private:
  using Entries = std::list<Entry>;
  using Place = Entries::iterator;

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
    std::array<Place, kChainPackets> chain;  ///< where what waits stands, of the newest only
    std::unique_ptr<RungController> rungs;
    /// Whether what becomes of the packet speaks of the rung: a still that was refined on a lower one is as large as at the
    /// top.
    [[nodiscard]] bool judged(const Entry& entry) const noexcept {
      return rungs && (rungs->rung() == 0 || (entry.flags & protocol::kFlagLast) == 0);
    }
    std::size_t rung = 0;  ///< where it has been told to be
  };
  using Streams = std::vector<Stream>;

  [[nodiscard]] Place first_waiting() noexcept { return std::next(entries_.begin(), front_begun_ ? 1 : 0); }
  [[nodiscard]] Streams::const_iterator find(std::uint32_t stream) const noexcept;
  [[nodiscard]] Stream* find(std::uint32_t stream) noexcept;
  [[nodiscard]] bool number(Stream& stream, const streams::Packet& packet);
  [[nodiscard]] Place make_place(Place before);
  void append(Stream& stream, Place place, const streams::PacketPtr& packet, std::int64_t now_us);
  void skip(Stream& stream, const streams::Packet& packet);
  void drop_chain(Stream& stream, std::int64_t now_us);
  void replace(Stream& stream, const streams::PacketPtr& packet, std::int64_t now_us);
  void waits_no_more(const Entry& entry) noexcept;
  Place take_out(Place place) noexcept;
  void notice_rung(Stream& stream) noexcept { moves_ = moves_ || stream.rungs->rung() != stream.rung; }

  Metrics& metrics_;
  Entries entries_;
  Entries spare_;    ///< memory of those that have gone, the warmest first
  Streams streams_;  ///< by number; few, and so flat
  std::size_t every_bytes_ = 0;
  bool front_begun_ = false;
  bool adaptive_ = false;  ///< one of the streams is
  bool moves_ = false;
};

}  // namespace tweend::net
