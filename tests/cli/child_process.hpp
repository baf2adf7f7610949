#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace tweend::cli::test {

/// A program with its standard output in a pipe; what it says on standard error is lost.
class ChildProcess {
 public:
  explicit ChildProcess(const std::vector<std::string>& command, const std::string& in = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// The next line of output, without its end; empty at the end.
  [[nodiscard]] std::string read_line();
  [[nodiscard]] std::string read_all();
  void send_signal(int signal) const;
  /// As `head` does when it has seen enough.
  void close_output();
  /// The exit code, or minus the signal that ended it.
  [[nodiscard]] int wait();

 private:
  pid_t pid_ = -1;
  int output_ = -1;
};

}  // namespace tweend::cli::test
