#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace tweend::bench {

/// The `tweend` beside the benchmark program, serving a port of the system's choice; ended when this goes.
class ServerProcess {
 public:
  ServerProcess();
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
  /// What all its threads have computed so far.
  [[nodiscard]] double cpu_seconds() const;

 private:
  pid_t pid_ = -1;
  std::string folder_;
  std::uint16_t port_ = 0;
};

/// A blocking connection that sends a line and waits for the line that answers it: the least a client can do.
/// What fails ends the program: a benchmark has nothing to measure then.
class LineClient {
 public:
  explicit LineClient(std::uint16_t port);
  ~LineClient();
  LineClient(const LineClient&) = delete;
  LineClient& operator=(const LineClient&) = delete;

  /// @param line  with its '\n'
  [[nodiscard]] std::string_view exchange(std::string_view line);

 private:
  int socket_ = -1;
  std::string received_;
};

/// Keeps the calling thread, and what it starts from here on, on one processor, where there are several. Whether two
/// threads that wake each other share one changes a round trip tenfold: left to chance, nothing could be compared.
void pin_to_processor(unsigned processor);

[[noreturn]] void give_up(const std::string& why);

}  // namespace tweend::bench
