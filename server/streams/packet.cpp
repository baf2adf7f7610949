#include "server/streams/packet.hpp"

#include <algorithm>
#include <utility>

namespace tweend::streams {
namespace {

/// What a pool keeps at most: a producer has a latest packet, one in the making and a few on sockets. Large ones are worth less
/// than the memory.
constexpr std::size_t kKept = 8;
constexpr std::size_t kKeptLarge = 1;
constexpr std::size_t kLargeBytes = std::size_t{8} << 20U;

}  // namespace

std::span<std::byte> Payload::resize(std::size_t bytes) {
  if (bytes > capacity_) {
    memory_ = std::make_unique_for_overwrite<std::byte[]>(kHeadroom + bytes);
    capacity_ = bytes;
  }
  size_ = bytes;
  return {memory_.get() + kHeadroom, size_};
}

void Payload::assign(std::span<const std::byte> bytes) { std::copy(bytes.begin(), bytes.end(), resize(bytes.size()).begin()); }

std::span<float> Payload::resize_floats(std::size_t count) {
  // operator new aligns for any number, and starts the lifetime of those that are written to it.
  return {reinterpret_cast<float*>(resize(count * sizeof(float)).data()), count};
}

std::span<const float> Payload::floats() const noexcept {
  return {reinterpret_cast<const float*>(memory_.get() + kHeadroom), size_ / sizeof(float)};
}

StreamMeter* Packet::meter() const noexcept { return pool_ ? pool_->meter_.get() : nullptr; }

ClockUs Packet::exchange_delay(ClockUs delay_us) const noexcept { return std::exchange(pool_->last_delay_us_, delay_us); }

NewPacketPtr PacketPool::take() {
  std::unique_ptr<Packet> packet;
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      packet = std::move(free_.back());
      free_.pop_back();
    }
  }
  if (!packet) packet = std::make_unique<Packet>();
  packet->header = {};
  packet->view_serial = 0;
  packet->pool_ = shared_from_this();
  return NewPacketPtr(packet.release());
}

void PacketPool::give_back(std::unique_ptr<Packet> packet) {
  const std::lock_guard lock(mutex_);
  const std::size_t most = packet->payload.capacity() > kLargeBytes ? kKeptLarge : kKept;
  if (free_.size() < most) free_.push_back(std::move(packet));
}

void Packet::give_back() const noexcept {
  std::unique_ptr<Packet> last(const_cast<Packet*>(this));
  // The packet must not keep alive the pool that keeps the packet.
  const std::shared_ptr<PacketPool> pool = std::move(last->pool_);
  pool->give_back(std::move(last));
}

}  // namespace tweend::streams
