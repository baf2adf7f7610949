#include "server/commands/wire_types.hpp"

#include <fmt/format.h>

namespace tweend::commands {

PlayerState player_state(const stage::SceneView& view, std::size_t player, ClockUs at_us) {
  const model::Actor& actor = *view.scene->actors[player];
  const stage::Player p = stage::reached(actor, (*view.players)[player], at_us);
  const model::ClipPtr clip = stage::clip_of(actor, p);
  const stage::PlayRange range = p.range_of(*clip);
  const stage::PlayerReading reading = p.read(range, at_us);
  return {p.actor, clip->name, reading.playing, reading.time_s, p.speed, p.loop, {range.in_s, range.out_s}, clip->duration_s()};
}

PlayersResult players_result(const stage::SceneView& view, const std::vector<std::size_t>& players, ClockUs at_us) {
  PlayersResult result{{}, at_us};
  result.players.reserve(players.size());
  for (const std::size_t i : players) result.players.push_back(player_state(view, i, at_us));
  return result;
}

Error no_such_scene(const std::string& scene) {
  return fail(ErrorCode::NotFound, fmt::format("expected the name of a scene, found \"{}\"; scene.list names them", scene),
              "params.scene");
}

Error no_such_actor(const model::Scene& scene, const std::string& actor) {
  return fail(ErrorCode::NotFound,
              fmt::format("expected the name of an actor of the scene \"{}\", found \"{}\"; scene.describe names them",
                          scene.name, actor),
              "params.actor");
}

Error no_mesh(const model::Actor& actor) {
  return fail(ErrorCode::InvalidParams,
              fmt::format("expected an actor with a mesh, found that \"{}\" is a skeleton alone", actor.name), "params.actor");
}

Error no_such_clip(const model::Actor& actor, const std::string& clip) {
  std::string names;
  for (const model::ClipPtr& c : actor.clips) names += (names.empty() ? "\"" : ", \"") + c->name + "\"";
  return fail(ErrorCode::NotFound,
              fmt::format("expected a clip of the actor \"{}\" ({}), found \"{}\"", actor.name, names, clip), "params.clip");
}

Result<model::ActorPtr> find_actor(const model::Scene& scene, const std::optional<std::string>& actor) {
  if (actor) {
    if (model::ActorPtr found = scene.find_actor(*actor)) return found;
    return no_such_actor(scene, *actor);
  }
  if (scene.actors.size() == 1) return scene.actors.front();
  if (scene.actors.empty()) {
    return fail(ErrorCode::NotFound,
                fmt::format("expected an actor in the scene \"{}\", found none; add one first", scene.name), "params.actor");
  }
  return fail(
      ErrorCode::InvalidParams,
      fmt::format("expected the name of one of the {} actors of the scene \"{}\", found none", scene.actors.size(), scene.name),
      "params.actor");
}

Result<model::ClipPtr> find_clip(const model::Actor& actor, const std::optional<std::string>& clip,
                                 const stage::SceneViewPtr& view) {
  if (clip) {
    if (model::ClipPtr found = actor.find_clip(*clip)) return found;
    return no_such_clip(actor, *clip);
  }
  const stage::Player* player = view ? view->find_player(actor.name) : nullptr;
  return player != nullptr ? stage::clip_of(actor, *player) : actor.clips.front();
}

}  // namespace tweend::commands
