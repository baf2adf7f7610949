#pragma once

#include "clients/cli/exit_code.hpp"

namespace tweend::cli {

class Session;
struct Arguments;

/// `watch frames`: opens a stream of pictures, and prints a line a packet or, where a folder was named, stores each in a file.
/// Throws Failure.
[[nodiscard]] ExitCode watch_frames(Session& session, const Arguments& arguments);

}  // namespace tweend::cli
