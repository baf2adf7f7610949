#pragma once

namespace tweend::cli {

/// What a script sees of a run (docs/PROTOCOL.md, section 9).
enum class ExitCode : int {
  Done = 0,
  Refused = 1,       ///< the server answered with an error, what was waited for did not come, or its answer can't be stored
  Usage = 2,         ///< the command line, or a file it names, is wrong: nothing was sent
  NoServer = 3,      ///< nobody listens there, or the connection was lost before the answer
  Interrupted = 130  ///< Ctrl-C, as a shell reports it
};

}  // namespace tweend::cli
