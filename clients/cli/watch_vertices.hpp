#pragma once

#include "clients/cli/exit_code.hpp"

namespace tweend::cli {

class Session;
struct Arguments;

/// Prints what a stream of vertices sends, a line a packet: how many, and the box around them. Throws Failure.
[[nodiscard]] ExitCode watch_vertices(Session& session, const Arguments& arguments);

}  // namespace tweend::cli
