#pragma once

#include <atomic>
#include <boost/smart_ptr/intrusive_ptr.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "protocol/packet.hpp"
#include "server/base/clock.hpp"
#include "server/streams/stream_meter.hpp"

namespace tweend::streams {

/// Bytes that keep their memory when they are written anew.
class Payload {
 public:
  /// Room for so many bytes, of undefined content.
  std::span<std::byte> resize(std::size_t bytes);
  /// The same, as numbers.
  std::span<float> resize_floats(std::size_t count);
  /// A copy of bytes, and room for these alone. An encoder whose length is known afterwards writes to memory of its own first:
  /// packets that wait for slow readers would each keep the room for the longest.
  void assign(std::span<const std::byte> bytes);

  [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return {memory_.get() + kHeadroom, size_}; }
  /// Room right before the bytes. It is the sinks' thread's: there each of many readers' framing is written in turn, right
  /// before the kernel is handed both in one piece, and so copies them once and not from two places.
  [[nodiscard]] std::span<std::byte> headroom() const noexcept { return {memory_.get(), memory_ ? kHeadroom : 0}; }
  [[nodiscard]] std::span<const float> floats() const noexcept;

 private:
  static constexpr std::size_t kHeadroom = 192;  ///< keeps the bytes aligned

  std::unique_ptr<std::byte[]> memory_;
  std::size_t capacity_ = 0;
  std::size_t size_ = 0;
};

class PacketPool;

/// One evaluated and encoded packet, shared by all its subscribers. `header.stream` is filled in for each of them.
/// Immutable once delivered, but for the headroom; goes back to its pool with its last reader.
class Packet {
 public:
  protocol::PacketHeader header;
  std::uint64_t source = 0;       ///< its producer: a stream that changes producers counts on from where it was
  std::uint64_t view_serial = 0;  ///< of the newest published view that it shows; the strand's
  Payload payload;                ///< as it goes on the wire (little-endian machines)
  /// Counts what becomes of it. Null before it has a pool.
  [[nodiscard]] StreamMeter* meter() const noexcept;
  /// Notes how long after its reading it was handed over. The sinks' thread's.
  /// @return the same of its pool's packet before; negative: there was none
  ClockUs exchange_delay(ClockUs delay_us) const noexcept;

 private:
  friend class PacketPool;
  friend void intrusive_ptr_add_ref(const Packet* packet) noexcept;
  friend void intrusive_ptr_release(const Packet* packet) noexcept;
  void give_back() const noexcept;
  mutable std::atomic<std::size_t> references_{0};
  std::shared_ptr<PacketPool> pool_;
};

using PacketPtr = boost::intrusive_ptr<const Packet>;
using NewPacketPtr = boost::intrusive_ptr<Packet>;  ///< while it is in the making

/// Packets of one producer, used again and again: once a stream runs, no packet is allocated. Safe from any thread.
class PacketPool : public std::enable_shared_from_this<PacketPool> {
 public:
  /// @param meter  what its packets are counted by
  explicit PacketPool(std::shared_ptr<StreamMeter> meter = std::make_shared<StreamMeter>()) : meter_(std::move(meter)) {}
  /// A packet to be filled and then shared as a PacketPtr; its payload is an earlier one's.
  [[nodiscard]] NewPacketPtr take();

 private:
  friend class Packet;
  void give_back(std::unique_ptr<Packet> packet);

  const std::shared_ptr<StreamMeter> meter_;
  ClockUs last_delay_us_ = -1;  ///< the sinks' thread's

  std::mutex mutex_;
  std::vector<std::unique_ptr<Packet>> free_;
};

inline void intrusive_ptr_add_ref(const Packet* packet) noexcept {
  packet->references_.fetch_add(1, std::memory_order_relaxed);
}
inline void intrusive_ptr_release(const Packet* packet) noexcept {
  if (packet->references_.fetch_sub(1, std::memory_order_acq_rel) == 1) packet->give_back();
}

}  // namespace tweend::streams
