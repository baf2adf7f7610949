#include "tests/cli/run_cli.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "clients/cli/program.hpp"

namespace tweend::cli::test {

namespace {

Outcome run_in_strings(std::vector<std::string> arguments, const std::string& in, std::size_t columns,
                       bool out_is_terminal = false) {
  std::istringstream input(in);
  std::ostringstream out;
  std::ostringstream err;
  const ExitCode code = run(std::move(arguments), Io{input, out, err, columns, out_is_terminal});
  return {code, out.str(), err.str()};
}

Outcome run_with(std::vector<Reaction> script, std::vector<std::string> arguments, const std::string& in, std::size_t columns) {
  FakeServer server(std::move(script));
  Outcome outcome = run_in_strings(speaking_to(server, std::move(arguments)), in, columns);
  // A client that never came would be waited for in vain.
  if (outcome.code != ExitCode::Usage) {
    EXPECT_EQ(server.complaints(), "");
  }
  return outcome;
}

}  // namespace

std::vector<std::string> speaking_to(const FakeServer& server, std::vector<std::string> arguments) {
  // A wait's own --timeout is another: how long it waits once it has an answer.
  const bool says_how_long = std::ranges::find(arguments, "--timeout") != arguments.end() && arguments.front() != "wait";
  if (!says_how_long) arguments.insert(arguments.begin(), {"--timeout", "60"});
  arguments.insert(arguments.begin(), {"--server", server.address()});
  return arguments;
}

std::vector<std::string> tweenctl(const FakeServer& server, std::vector<std::string> arguments) {
  arguments = speaking_to(server, std::move(arguments));
  arguments.insert(arguments.begin(), TWEENCTL);
  return arguments;
}

Outcome run_alone(std::vector<std::string> arguments, const std::string& in) {
  return run_in_strings(std::move(arguments), in, 0);
}

Outcome run_alone_to_terminal(std::vector<std::string> arguments) { return run_in_strings(std::move(arguments), {}, 0, true); }

Outcome run_cli(std::vector<Reaction> script, std::vector<std::string> arguments, const std::string& in) {
  return run_with(std::move(script), std::move(arguments), in, 0);
}

Outcome run_on_terminal(std::vector<Reaction> script, std::vector<std::string> arguments, std::size_t columns) {
  return run_with(std::move(script), std::move(arguments), {}, columns);
}

}  // namespace tweend::cli::test
