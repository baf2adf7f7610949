#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "clients/cli/exit_code.hpp"

namespace tweend::cli {

/// Why a command was not carried out. Thrown wherever it turns out, caught once, in run(): it never leaves this library.
struct Failure : std::runtime_error {
  Failure(ExitCode code, const std::string& line) : std::runtime_error(line), exit_code(code) {}
  ExitCode exit_code;
};

/// The command line, or a file that it names, is wrong.
struct Usage : Failure {
  explicit Usage(const std::string& line) : Failure(ExitCode::Usage, line) {}
};

/// No connection, a lost one, or one whose other end does not speak the protocol.
struct NoServer : Failure {
  explicit NoServer(const std::string& line) : Failure(ExitCode::NoServer, line) {}
};

/// Nothing arrived before the deadline. The connection is as it was: reading may go on.
struct TimedOut : NoServer {
  using NoServer::NoServer;
};

/// The server answered with an error.
struct Refusal : Failure {
  Refusal(const std::string& line, std::string raw_error) : Failure(ExitCode::Refused, line), error(std::move(raw_error)) {}
  std::string error;  ///< the JSON-RPC error object as it came, one line
};

}  // namespace tweend::cli
