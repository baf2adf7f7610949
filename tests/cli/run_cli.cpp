#include "tests/cli/run_cli.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "clients/cli/program.hpp"

namespace tweend::cli::test {

Outcome run_alone(std::vector<std::string> arguments, const std::string& in) {
  std::istringstream input(in);
  std::ostringstream out;
  std::ostringstream err;
  const ExitCode code = run(std::move(arguments), Io{input, out, err});
  return {code, out.str(), err.str()};
}

Outcome run_cli(std::vector<Reaction> script, std::vector<std::string> arguments, const std::string& in) {
  FakeServer server(std::move(script));
  arguments.insert(arguments.begin(), {"--server", server.address()});
  Outcome outcome = run_alone(std::move(arguments), in);
  // A client that never came would be waited for in vain.
  if (outcome.code != ExitCode::Usage) {
    EXPECT_EQ(server.complaints(), "");
  }
  return outcome;
}

}  // namespace tweend::cli::test
