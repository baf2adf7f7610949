#include "server/commands/wire_types.hpp"

#include <fmt/format.h>

#include <algorithm>

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

std::vector<JointState> joint_states(const model::Model& model) {
  std::vector<JointState> states;
  if (!model.skeleton) return states;
  const std::vector<model::Joint>& joints = model.skeleton->joints();
  for (const model::Joint& joint : joints) {
    JointState& state = states.emplace_back(JointState{joint.name, {}});
    if (joint.parent >= 0) state.parent = joints[static_cast<std::size_t>(joint.parent)].name;
  }
  return states;
}

std::vector<std::string> weight_names(const model::Model& model) {
  std::vector<std::string> names;
  if (!model.morphs) return names;
  for (const model::MorphTarget& target : model.morphs->targets()) names.push_back(target.name);
  return names;
}

Error no_skeleton(const model::Actor& actor) {
  return fail(ErrorCode::InvalidParams,
              fmt::format("expected an actor with a skeleton, found that \"{}\" has none", actor.name), "params.actor");
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

Result<Moment> moment_of(const model::ActorPtr& actor, const std::optional<std::string>& clip, std::optional<double> time_s,
                         const stage::SceneViewPtr& view, ClockUs now_us) {
  TWEEND_ASSIGN(const model::ClipPtr found, find_clip(*actor, clip, view));
  const stage::ActorShow now = stage::show_actor(actor, *view->find_player(actor->name), now_us);
  if (!time_s && found == now.clip) return Moment{now.time_s, now.shown};
  const double at_s = std::clamp(time_s.value_or(now.time_s), 0.0, found->duration_s());
  return Moment{at_s, model::shown_clip(found, at_s)};
}

}  // namespace tweend::commands
