#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tweend::bench {

/// Many readers on loopback in a process of their own that does nothing but empty their sockets.
class DrainingProcess {
 public:
  /// Forks: to be made before there are threads.
  /// @param most_readers  what connect() may ask for altogether
  explicit DrainingProcess(std::size_t most_readers);
  /// Ends the process.
  ~DrainingProcess();
  DrainingProcess(const DrainingProcess&) = delete;
  DrainingProcess& operator=(const DrainingProcess&) = delete;

  /// Connects so many readers more. The answer is the other ends, as descriptors that are the caller's.
  [[nodiscard]] std::vector<int> connect(std::size_t readers);

  /// So many bytes more are on their way to the readers altogether.
  void expect(std::uint64_t bytes) noexcept { expected_ += bytes; }
  /// Whether all of them have been read. Lets another process have its turn.
  [[nodiscard]] bool done() const;
  /// From now on each reader keeps what it reads, up to so many bytes; 0: no longer.
  void keep(std::size_t bytes);
  /// What reader `index` has kept, in the order in which they were connected.
  [[nodiscard]] std::string kept(std::size_t index) const;

 private:
  struct Shared;
  Shared* shared_;
  std::size_t most_readers_;
  std::size_t connected_ = 0;
  std::uint64_t expected_ = 0;
  int listener_ = -1;
  int orders_ = -1;  ///< a pipe: how many readers to connect
  pid_t child_ = -1;
};

}  // namespace tweend::bench
