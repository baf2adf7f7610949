#include "server/commands/playback_targets.hpp"

namespace tweend::commands {

Result<Concerned> concerned_players(const model::Scene& scene, const std::optional<std::string>& actor) {
  Concerned indices;
  for (std::size_t i = 0; i < scene.actors.size(); ++i) {
    if (!actor || scene.actors[i]->name == *actor) indices.push_back(i);
  }
  if (actor && indices.empty()) return no_such_actor(scene, *actor);
  return indices;
}

}  // namespace tweend::commands
