#pragma once

#include "server/app/options.hpp"

namespace tweend::app {

/// Runs the server until SIGTERM or SIGINT. @return the process's exit code: 0 after a signal, 1 if it could not start
[[nodiscard]] int serve(const ServeOptions& options);

}  // namespace tweend::app
