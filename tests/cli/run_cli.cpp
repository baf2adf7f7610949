#include "tests/cli/run_cli.hpp"

#include <gtest/gtest.h>

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
  arguments.insert(arguments.begin(), {"--server", server.address()});
  Outcome outcome = run_in_strings(std::move(arguments), in, columns);
  // A client that never came would be waited for in vain.
  if (outcome.code != ExitCode::Usage) {
    EXPECT_EQ(server.complaints(), "");
  }
  return outcome;
}

}  // namespace

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
