#pragma once

#include "clients/cli/exit_code.hpp"

namespace tweend::cli {

class Session;
struct Arguments;

/// Prints what a stream of poses sends, a line a packet: how many joints, and where the first stands relative to its parent.
/// Throws Failure.
[[nodiscard]] ExitCode watch_pose(Session& session, const Arguments& arguments);

}  // namespace tweend::cli
