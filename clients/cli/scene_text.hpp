#pragma once

#include <iosfwd>

#include "clients/cli/json.hpp"

namespace tweend::cli {

/// The players of a `playback.*` answer as a table.
void print_players(std::ostream& out, const Json& players);

/// A `scene.describe` answer as a page: camera, light, actors, their players and clips.
void print_scene(std::ostream& out, const Json& scene);

/// The clips of all actors of a `scene.describe` answer, each with a member `actor`.
[[nodiscard]] Json clips_of(const Json& scene);

/// The player's place and state in a few words: `walk playing 1.25 of 4 s`.
[[nodiscard]] std::string player_text(const Json& player);

}  // namespace tweend::cli
