#pragma once

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

/// Hands packets over to the thread of their sinks, in order: one wake-up for all that wait, and no memory taken for a packet
/// once the lists have grown to their size. Safe from any thread; outlives the tasks it posts.
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

  const Post post_;
  std::mutex mutex_;
  std::vector<Entry> waiting_;
  std::vector<Entry> draining_;  ///< the sinks' thread only
};

}  // namespace tweend::streams
