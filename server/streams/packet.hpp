#pragma once

#include <atomic>
#include <boost/smart_ptr/intrusive_ptr.hpp>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "protocol/packet.hpp"

namespace tweend::streams {

class PacketPool;

/// One evaluated and encoded packet, shared by all its subscribers. `header.stream` is filled in for each of them.
/// Immutable once delivered; goes back to its pool with its last reader.
class Packet {
 public:
  protocol::PacketHeader header;
  std::uint64_t source = 0;    ///< its producer: a stream that changes producers counts on from where it was
  std::vector<float> payload;  ///< as it goes on the wire (little-endian machines)

  [[nodiscard]] std::span<const std::byte> payload_bytes() const noexcept { return std::as_bytes(std::span(payload)); }

 private:
  friend class PacketPool;
  friend void intrusive_ptr_add_ref(const Packet* packet) noexcept;
  friend void intrusive_ptr_release(const Packet* packet) noexcept;
  mutable std::atomic<std::size_t> references_{0};
  std::shared_ptr<PacketPool> pool_;
};

using PacketPtr = boost::intrusive_ptr<const Packet>;

/// Packets of one producer, used again and again: once a stream runs, no packet is allocated. Safe from any thread.
class PacketPool : public std::enable_shared_from_this<PacketPool> {
 public:
  /// A packet with room for `floats` values, to be filled and then shared as a PacketPtr.
  [[nodiscard]] boost::intrusive_ptr<Packet> take(std::size_t floats);

 private:
  friend void intrusive_ptr_release(const Packet* packet) noexcept;
  void give_back(std::unique_ptr<Packet> packet);

  std::mutex mutex_;
  std::vector<std::unique_ptr<Packet>> free_;
};

void intrusive_ptr_add_ref(const Packet* packet) noexcept;
void intrusive_ptr_release(const Packet* packet) noexcept;

}  // namespace tweend::streams
