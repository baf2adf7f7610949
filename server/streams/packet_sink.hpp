#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "server/streams/packet.hpp"

namespace tweend::streams {

/// Where packets go: a connection. Called on the thread that `Hub` was given to deliver on.
class PacketSink {
 public:
  virtual ~PacketSink() = default;
  /// Takes a packet or skips it; never waits. What is taken leaves with the next flush().
  virtual void offer(std::uint32_t stream, const PacketPtr& packet) = 0;
  /// Follows a run of offers, so that all of them leave together.
  virtual void flush() = 0;
  /// The last word of a stream whose actor or scene is gone.
  virtual void ended(std::uint32_t stream, const std::string& reason) = 0;
};

struct Subscription {
  std::weak_ptr<PacketSink> sink;
  std::uint32_t stream = 0;
};
using Subscriptions = std::vector<Subscription>;

}  // namespace tweend::streams
