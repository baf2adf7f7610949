#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "server/base/clock.hpp"
#include "server/model/scene.hpp"
#include "server/model/shown.hpp"
#include "server/stage/player.hpp"

namespace tweend::stage {

using Players = std::vector<Player>;  ///< one for each actor of the scene, in its order

/// A published scene: an immutable document and the players over it. `serial` grows with each publication of the scene.
struct SceneView {
  model::ScenePtr scene;
  std::shared_ptr<const Players> players;
  std::uint64_t serial = 0;

  [[nodiscard]] const Player* find_player(std::string_view actor) const noexcept;
};
using SceneViewPtr = std::shared_ptr<const SceneView>;

/// Everything that is published, at one instant.
struct StageView {
  std::map<std::string, SceneViewPtr, std::less<>> scenes;

  [[nodiscard]] SceneViewPtr find(std::string_view scene) const noexcept;
};
using StageViewPtr = std::shared_ptr<const StageView>;

/// What one actor shows at a clock reading. A value; holds what it shows alive.
struct ActorShow {
  model::ActorPtr actor;
  model::ClipPtr clip;          ///< the player's own
  double time_s = 0.0;          ///< of that clip
  model::Shown shown;           ///< with what fades into it, and what lies over it
  double spin_angle_rad = 0.0;  ///< about the actor's +Y
  bool moving = false;          ///< what is shown changes while the clock runs: time, or a fade
  bool turning = false;         ///< the spin does
  /// Changes exactly where what is shown may jump though time does not: seeks, clip changes, wraps of an open clip.
  std::uint64_t continuity = 0;
};

/// What a scene shows at a clock reading: shown = f(revision, show, camera).
struct Show {
  model::ScenePtr scene;
  ClockUs at_us = 0;
  std::vector<ActorShow> actors;
};

/// Allocates nothing, but for a player whose queue has moved on since the view was published.
[[nodiscard]] ActorShow show_actor(const model::ActorPtr& actor, const Player& player, ClockUs at_us) noexcept;
/// What is shown at a reading of the clock.
[[nodiscard]] Show show_at(const SceneView& view, ClockUs at_us);
/// The same, into a show that keeps its memory.
void show_at(const SceneView& view, ClockUs at_us, Show& out);
/// Each actor's current clip at `time_s`, clamped to the clip; no spin: a `time` stands outside of playing.
void show_time(const SceneView& view, double time_s, ClockUs now_us, Show& out);

}  // namespace tweend::stage
