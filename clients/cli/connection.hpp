#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "clients/cli/json.hpp"
#include "clients/cli/socket.hpp"
#include "protocol/packet.hpp"

namespace tweend::cli {

/// A stream packet.
struct Packet {
  protocol::PacketHeader header;
  std::string payload;
};

/// What a server sends: a line of JSON or a packet.
struct Message {
  std::string line;  ///< empty for a packet
  std::optional<Packet> packet;
};

/// Line JSON to a server (docs/PROTOCOL.md, section 1). Used by one thread.
class Connection {
 public:
  /// Throws NoServer.
  Connection(const Endpoint& endpoint, Deadline deadline) : socket_(endpoint, deadline) {}

  /// Asks, and waits for the answer. Events and packets that come before it are kept for next().
  /// Throws Refusal, NoServer or TimedOut.
  [[nodiscard]] Json call(std::string_view method, const Json& params, Deadline deadline);

  /// The next event or packet, in the order they came. Throws NoServer or TimedOut.
  [[nodiscard]] Message next(Deadline deadline);

 private:
  [[nodiscard]] Message read(Deadline deadline);
  [[nodiscard]] std::string read_line(Deadline deadline);
  [[nodiscard]] Packet read_packet(const Json& announcement, Deadline deadline);
  void need(std::size_t size, Deadline deadline);
  [[nodiscard]] std::string take(std::size_t size);

  Socket socket_;
  std::string buffer_;  ///< arrived; what lies before taken_ has been used
  std::size_t taken_ = 0;
  std::deque<Message> kept_;
  std::int64_t last_id_ = 0;
};

}  // namespace tweend::cli
