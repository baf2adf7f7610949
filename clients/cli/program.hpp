#pragma once

#include <string>
#include <vector>

#include "clients/cli/exit_code.hpp"
#include "clients/cli/session.hpp"

namespace tweend::cli {

/// Runs tweenctl. Throws nothing; what went wrong is said in one line on io.err.
/// @param arguments  as on the command line, without the program's name
[[nodiscard]] ExitCode run(std::vector<std::string> arguments, const Io& io);

}  // namespace tweend::cli
