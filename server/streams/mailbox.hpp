#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "server/base/worker_pool.hpp"
#include "server/streams/packet.hpp"
#include "server/streams/packet_sink.hpp"

namespace tweend::streams {

/// A packet on its way to some readers.
struct Delivery {
  PacketPtr packet;
  std::shared_ptr<const Subscriptions> to;
};

/// Hands packets over to the thread of their sinks, in order: one wake-up for all that wait, then one flush of each sink, and
/// no memory taken for a packet once the lists have grown to their size. Safe from any thread; outlives the tasks it posts.
class Mailbox {
 public:
  explicit Mailbox(Post post) : post_(std::move(post)) {}

  void put(Delivery delivery);

  /// For rare things that must keep their place between packets.
  void call(Task task);

 private:
  void drain();

  struct Entry {
    Delivery delivery;
    Task task;
  };
  void append(Entry entry);
  std::size_t offer_run(std::size_t begin);

  const Post post_;
  std::mutex mutex_;
  std::vector<Entry> waiting_;
  // The sinks' thread only:
  std::vector<Entry> draining_;
  std::vector<std::shared_ptr<PacketSink>> touched_;  ///< have been offered something
};

}  // namespace tweend::streams
