#pragma once

#include <string>

#include "clients/cli/command.hpp"

namespace tweend::cli {

// Options for what is drawn and how; each returns the command it was given.

/// The fields of camera.set.
/// @param into  the parameter whose members they are, `camera/`; empty: they are parameters themselves
Command& with_camera(Command& command, const std::string& into);

/// --width, --height or --size.
Command& with_size(Command& command);

/// --width, --height or --size, --quality, and the viewer's own camera as the parameter `camera`.
Command& with_picture(Command& command);

/// A camera as the server takes it. An orbit looks at a target of its own: where both are given, --target is meant for it.
[[nodiscard]] Json orbit_with_target(Json camera);

/// The request's parameters, what with_picture() read among them.
[[nodiscard]] Json picture_params(const Arguments& arguments);

}  // namespace tweend::cli
