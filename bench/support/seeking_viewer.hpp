#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "protocol/packet.hpp"

namespace tweend::bench {

/// A connection of line JSON with one stream on it that seeks, and takes the time until it sees where it went.
/// Blocking; what fails ends the program.
class SeekingViewer {
 public:
  /// Asks for the stream and waits for its first packet.
  /// @param params  of `stream.open`
  SeekingViewer(std::uint16_t port, const std::string& params);
  ~SeekingViewer();
  SeekingViewer(const SeekingViewer&) = delete;
  SeekingViewer& operator=(const SeekingViewer&) = delete;

  /// Takes what comes for so long.
  void rest(double seconds);
  /// From the first byte of a `server.ping` sent to the last of its answer received, milliseconds.
  [[nodiscard]] double ping_ms();
  using Shows = std::function<bool(const protocol::PacketHeader&)>;
  /// From the first byte of a `playback.seek` sent to the last received of the first packet that shows it, milliseconds.
  [[nodiscard]] double seek_ms(double time_s, const Shows& shows);

  /// Of the packet that came last.
  [[nodiscard]] const protocol::PacketHeader& header() const noexcept { return header_; }
  [[nodiscard]] std::string_view payload() const noexcept { return payload_; }

 private:
  void send(const std::string& line);
  /// Receives until `done`, which is asked after each message.
  template <class Done>
  void receive_until(Done done);
  /// @return false: nothing has come within that time
  [[nodiscard]] bool receive_some(double seconds);
  /// Takes the next message, if all of it is there.
  [[nodiscard]] bool take();
  [[nodiscard]] bool all_answered() const noexcept { return answered_ == asked_; }

  int socket_ = -1;
  std::string received_;
  std::size_t taken_ = 0;  ///< bytes of it
  std::size_t asked_ = 0;
  std::size_t answered_ = 0;
  std::size_t packets_ = 0;
  protocol::PacketHeader header_;
  std::string payload_;
};

}  // namespace tweend::bench
