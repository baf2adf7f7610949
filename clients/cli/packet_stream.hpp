#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "clients/cli/connection.hpp"
#include "clients/cli/exit_code.hpp"
#include "server/base/clock.hpp"

namespace tweend::cli {

class Session;
struct Arguments;

/// A stream of packets of any kind. Used by one thread.
class PacketStream {
 public:
  /// Compares the clocks and opens the stream. Throws Refusal or NoServer.
  /// @param params  of stream.open
  PacketStream(Session& session, const Json& params);

  /// The next packet. Throws NoServer, TimedOut, or Failure once the server has ended the stream.
  [[nodiscard]] Packet next(Deadline deadline);

  /// What the server told of the stream as a whole.
  [[nodiscard]] const Json& layout() const noexcept { return layout_; }
  /// How long ago held what the packet shows.
  [[nodiscard]] ClockUs age_us(const Packet& packet, ClockUs now_us) const noexcept;

 private:
  void check_ended(const std::string& line) const;

  Session& session_;
  std::int64_t offset_us_;  ///< the server's clock minus ours
  Json stream_;             ///< its number
  Json layout_;
};

/// Prints a line a packet, until --count of them have come or nobody reads the lines any more. Throws what next() throws.
/// @param line  of a packet and its age
ExitCode print_packets(const Session& session, PacketStream& stream, const Arguments& arguments,
                       const std::function<std::string(const Packet& packet, ClockUs age_us)>& line);

/// The beginning of a packet's line: its number, media time, age and flags.
[[nodiscard]] std::string packet_text(const Packet& packet, ClockUs age_us);

/// The header's fields for programs, but for the size of the payload: what it counts depends on the kind.
[[nodiscard]] Json packet_json(const Packet& packet, ClockUs age_us);

}  // namespace tweend::cli
