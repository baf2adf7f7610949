#pragma once

#include <string>
#include <string_view>

#include "server/base/result.hpp"
#include "server/commands/services.hpp"

namespace tweend::app {

/// A name for the actor of an asset: its last path component without extension, other characters than a name may have
/// replaced by '_'.
[[nodiscard]] std::string actor_name(const std::string& asset);

/// Adds the asset to the scene main as an actor, unless an actor of that name is there; the commands' own way, so that it is
/// an edit like any other. Waits for it. Not for the stage's or a worker's thread.
[[nodiscard]] Status load_asset(const commands::Services& services, const std::string& asset);

/// Carries out an edit of the scene main by its method's name and parameters, as a client would. Waits for it.
/// Not for the stage's or a worker's thread.
[[nodiscard]] Status run_edit(const commands::Services& services, std::string_view method, const std::string& params_json);

/// Puts an actor of the scene main on a clip, at its start and paused. Waits for it.
/// @return NotFound where it has none of that name
[[nodiscard]] Status show_clip(const commands::Services& services, const std::string& actor, const std::string& clip);

/// Plays every actor of the scene main. Waits for it.
[[nodiscard]] Status play_all(const commands::Services& services);

}  // namespace tweend::app
