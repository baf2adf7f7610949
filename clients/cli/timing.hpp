#pragma once

#include "clients/cli/command.hpp"

namespace tweend::cli {

/// --at and --late: the command can be kept for a reading of the server's clock.
Command& with_timing(Command& command);

/// The parameters, with `at_us` where --at was given: `+SECONDS` counts from the server's clock of this moment.
[[nodiscard]] Json timed_params(Session& session, const Arguments& arguments);

/// What was answered in place of the result: when the command will be carried out. Empty: it has been.
[[nodiscard]] std::string scheduled_text(const Json& result);

}  // namespace tweend::cli
