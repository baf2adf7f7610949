#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "clients/cli/program.hpp"

int main(int argc, char** argv) {
  using namespace tweend::cli;
  // What has been printed has been flushed line by line: nothing is lost by leaving at once.
  std::signal(SIGINT, [](int) { std::_Exit(static_cast<int>(ExitCode::Interrupted)); });
  std::signal(SIGPIPE, SIG_DFL);  // `tweenctl events | head` ends with head, whatever our parent ignored
  std::ios::sync_with_stdio(false);
  return static_cast<int>(run({argv + 1, argv + argc}, Io{std::cin, std::cout, std::cerr}));
}
