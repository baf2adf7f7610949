#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "clients/cli/endpoint.hpp"

namespace tweend::cli {

/// When to give up; empty: never.
using Deadline = std::optional<std::chrono::steady_clock::time_point>;

/// The deadline so many seconds from now.
[[nodiscard]] Deadline deadline_in(double seconds);

/// A TCP connection whose every operation ends at a deadline. Used by one thread.
class Socket {
 public:
  /// Throws NoServer.
  Socket(const Endpoint& endpoint, Deadline deadline);
  Socket(Socket&&) noexcept;
  Socket& operator=(Socket&&) noexcept;
  ~Socket();

  /// A failure to send shows in what is read next, which may well be the server's answer why (a message over its size limit):
  /// so only the deadline is reported here, as TimedOut.
  void send(std::string_view bytes, Deadline deadline);

  /// Appends what has arrived, at least a byte; false: the connection has ended. Throws TimedOut.
  [[nodiscard]] bool read_some(std::string& bytes, Deadline deadline);

 private:
  struct Asio;  // its headers stay in socket.cpp
  std::unique_ptr<Asio> asio_;
};

}  // namespace tweend::cli
