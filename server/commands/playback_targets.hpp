#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/commands/wire_types.hpp"
#include "server/stage/stage.hpp"

// Whom a playback.* means, and doing the same to all of them.

namespace tweend::commands {

using Concerned = std::vector<std::size_t>;  ///< indices of players

template <class T>
void add_player_fields(FieldList<T>& f) {
  add_scene_field(f);
  f.template add<&T::actor>("actor", "Name of the actor; every actor of the scene, in lockstep, if left out.");
}

/// Parameters that every playback.* but get takes. Derive, and call add_timed_player_fields first in describe().
struct PlayerTarget : Timed {
  std::optional<std::string> scene;
  std::optional<std::string> actor;
};

template <class T>
void add_timed_player_fields(FieldList<T>& f) {
  add_player_fields(f);
  add_timed_fields(f);
}

/// One player with the clip it is on and the range in force.
struct PlayerOnClip {
  std::size_t index;
  stage::Player& player;
  const model::Actor& actor;
  model::ClipPtr clip;
  [[nodiscard]] stage::PlayRange range() const noexcept { return player.range_of(*clip); }
};

/// @return NotFound: there is no actor of that name
[[nodiscard]] Result<Concerned> concerned_players(const model::Scene& scene, const std::optional<std::string>& actor);

/// Does `act` to every player concerned, all at the same reading. An error leaves all of them as they were.
template <class Act>
Result<Concerned> for_players(const std::optional<std::string>& actor, const stage::PlayersTurn& turn, Act&& act) {
  TWEEND_ASSIGN(Concerned indices, concerned_players(turn.scene, actor));
  for (const std::size_t i : indices) {
    const model::Actor& a = *turn.scene.actors[i];
    PlayerOnClip target{i, turn.players[i], a, stage::clip_of(a, turn.players[i])};
    TWEEND_TRY(act(target));
  }
  return indices;
}

}  // namespace tweend::commands
