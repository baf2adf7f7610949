#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "server/base/clock.hpp"
#include "server/base/metrics.hpp"
#include "server/base/worker_pool.hpp"
#include "server/streams/packet.hpp"
#include "server/streams/packet_sink.hpp"

namespace tweend::streams {

/// A packet on its way to some readers.
struct Delivery {
  PacketPtr packet;
  std::shared_ptr<const Subscriptions> to;
  bool again = false;  ///< others were handed it before: its delay has been measured
};

/// Hands packets over to the thread of their sinks, in order: one wake-up for all that wait, then one flush of each sink, and
/// no memory taken for a packet once the lists have grown to their size. Measures how late they are then. Safe from any thread;
/// outlives the tasks it posts.
class Mailbox {
 public:
  Mailbox(Post post, Metrics& metrics) : post_(std::move(post)), metrics_(metrics) {}

  void put(Delivery delivery);

  /// For rare things that must keep their place between packets.
  void call(Task task);

  /// How often it has been emptied: where that stays the same, all that was put since waits.
  [[nodiscard]] std::uint64_t drains() const noexcept { return drains_.load(std::memory_order_relaxed); }

 private:
  void drain();

  struct Entry {
    Delivery delivery;
    Task task;
  };
  void append(Entry entry);
  std::size_t offer_run(std::size_t begin);
  void measure(const Delivery& delivery, ClockUs now_us);

  const Post post_;
  Metrics& metrics_;
  std::atomic<std::uint64_t> drains_{0};
  std::mutex mutex_;
  std::vector<Entry> waiting_;
  // The sinks' thread only:
  std::vector<Entry> draining_;
  std::vector<std::shared_ptr<PacketSink>> touched_;  ///< have been offered something
};

}  // namespace tweend::streams
