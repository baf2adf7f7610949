#include <sys/ioctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "clients/cli/program.hpp"

namespace {

/// Of the terminal on standard error; 0: it is none.
std::size_t err_columns() {
  constexpr std::size_t kUsual = 80;  // for terminals that do not know
  if (isatty(STDERR_FILENO) == 0) return 0;
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace tweend::cli;
  // What has been printed has been flushed line by line: nothing is lost by leaving at once.
  std::signal(SIGINT, [](int) { std::_Exit(static_cast<int>(ExitCode::Interrupted)); });
  std::signal(SIGPIPE, SIG_DFL);  // `tweenctl events | head` ends with head, whatever our parent ignored
  std::ios::sync_with_stdio(false);
  return static_cast<int>(
      run({argv + 1, argv + argc}, Io{std::cin, std::cout, std::cerr, err_columns(), isatty(STDOUT_FILENO) != 0}));
}
