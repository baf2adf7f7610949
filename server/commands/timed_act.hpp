#pragma once

#include <string>

#include "server/commands/command.hpp"

namespace tweend::commands {

/// What the stage does with a command that carries `at_us`, as of that reading. It keeps the parameters, and nothing of the
/// connection it came by. Precondition: `command.timed`.
/// @return InvalidParams: an edit that names a revision or a retry key, which speak of the moment of the request
[[nodiscard]] Result<stage::TimedAct> timed_act(const Command& command, const Params& params, const Services& services);

/// The scene that it is about.
[[nodiscard]] std::string timed_scene(const Command& command, const Params& params);

}  // namespace tweend::commands
