#include "server/streams/packet.hpp"

#include <utility>

namespace tweend::streams {
namespace {

/// What a pool keeps at most: a producer has a latest packet, one in the making and a few on sockets.
constexpr std::size_t kKept = 8;

}  // namespace

boost::intrusive_ptr<Packet> PacketPool::take(std::size_t floats) {
  std::unique_ptr<Packet> packet;
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      packet = std::move(free_.back());
      free_.pop_back();
    }
  }
  if (!packet) packet = std::make_unique<Packet>();
  packet->payload.resize(floats);
  packet->header = {};
  packet->pool_ = shared_from_this();
  return boost::intrusive_ptr<Packet>(packet.release());
}

void PacketPool::give_back(std::unique_ptr<Packet> packet) {
  const std::lock_guard lock(mutex_);
  if (free_.size() < kKept) free_.push_back(std::move(packet));
}

void intrusive_ptr_add_ref(const Packet* packet) noexcept { packet->references_.fetch_add(1, std::memory_order_relaxed); }

void intrusive_ptr_release(const Packet* packet) noexcept {
  if (packet->references_.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  std::unique_ptr<Packet> last(const_cast<Packet*>(packet));
  // The packet must not keep alive the pool that keeps the packet.
  const std::shared_ptr<PacketPool> pool = std::move(last->pool_);
  pool->give_back(std::move(last));
}

}  // namespace tweend::streams
