#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "clients/cli/exit_code.hpp"
#include "tests/cli/fake_server.hpp"

namespace tweend::cli::test {

/// What a run of tweenctl left behind.
struct Outcome {
  ExitCode code = ExitCode::Done;
  std::string out;
  std::string err;
};

/// Arguments that speak to this server, and wait for its answers for longer than it can take unless they say how long.
[[nodiscard]] std::vector<std::string> speaking_to(const FakeServer& server, std::vector<std::string> arguments);
/// The same for a process of its own.
[[nodiscard]] std::vector<std::string> tweenctl(const FakeServer& server, std::vector<std::string> arguments);

/// Runs tweenctl in this process, without a server.
[[nodiscard]] Outcome run_alone(std::vector<std::string> arguments, const std::string& in = {});
/// The same where standard output is a terminal.
[[nodiscard]] Outcome run_alone_to_terminal(std::vector<std::string> arguments);

/// Runs it against a server that plays this script, and checks that the script was played to its end.
[[nodiscard]] Outcome run_cli(std::vector<Reaction> script, std::vector<std::string> arguments, const std::string& in = {});

/// The same where standard error is a terminal with so many columns.
[[nodiscard]] Outcome run_on_terminal(std::vector<Reaction> script, std::vector<std::string> arguments, std::size_t columns);

}  // namespace tweend::cli::test
