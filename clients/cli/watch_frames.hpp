#pragma once

#include "clients/cli/exit_code.hpp"

namespace tweend::cli {

class Session;
struct Arguments;

/// `watch frames`: opens a stream of pictures, and prints a line a packet or stores what comes: files in a folder, or where the
/// encoding is one of streams (h264, rgba), all in one file.
/// Throws Failure.
[[nodiscard]] ExitCode watch_frames(Session& session, const Arguments& arguments);

}  // namespace tweend::cli
