#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "server/streams/producer.hpp"

namespace tweend::commands {

/// How a stream's packets are to reach a client.
struct StreamPolicy {
  bool every = false;     ///< none is skipped: one that falls too far behind is disconnected; else the newest only
  bool adaptive = false;  ///< goes down the ladder of rungs.hpp where the client can't take more, and up again
};

/// The way back to one client, as a conversation sees it. Implemented by the connections; network thread only.
class Peer : public streams::PacketSink {
 public:
  /// Whether notifications and packets can reach this client (not over a single HTTP request).
  [[nodiscard]] virtual bool can_push() const noexcept = 0;
  /// An answer or a notification: one whole JSON message.
  virtual void send(std::string json) = 0;
  /// A notification that must not overtake the packets that wait already.
  virtual void send_after_packets(std::shared_ptr<const std::string> json) = 0;
  virtual void send_shared(std::shared_ptr<const std::string> json) = 0;
  /// True while what was sent has not been taken: nothing more is started for this client.
  [[nodiscard]] virtual bool congested() const noexcept = 0;
  /// Before a stream's first packet. What it does not hear of is delivered as a StreamPolicy says by default.
  virtual void expect_stream(std::uint32_t stream, StreamPolicy policy) = 0;
  /// Forgets what waits of a stream that was closed.
  virtual void forget_stream(std::uint32_t stream) = 0;
};

}  // namespace tweend::commands
