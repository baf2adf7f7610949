#include "clients/cli/scene_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "clients/cli/format.hpp"

namespace tweend::cli {
namespace {

std::string state(const Json& player) { return player.value("playing", false) ? "playing" : "paused"; }

/// Actors of a scene know their player without its actor's name; tables want both in one object.
Json players_of(const Json& scene) {
  Json players = Json::array();
  for (const Json& actor : scene.at("actors")) {
    if (!actor.contains("player") || !actor.at("player").is_object()) continue;
    Json player = actor.at("player");
    player["actor"] = actor.at("actor");
    players.push_back(std::move(player));
  }
  return players;
}

void print_clips(std::ostream& out, const Json& clips) {
  Table table({"actor", "clip", "type", "keyframes", "duration", "closed"});
  for (const Json& clip : clips) table.row_of(clip, {"actor", "clip", "type", "keyframes", "duration", "closed"});
  table.print(out);
}

void print_actors(std::ostream& out, const Json& actors) {
  Table table({"actor", "source", "vertices", "triangles", "joints", "interpolation", "transform"});
  for (const Json& actor : actors) {
    const std::size_t joints = actor.contains("joints") ? actor.at("joints").size() : 0;
    table.row({brief_member(actor, "actor"), brief_member(actor, "source"), brief_member(actor, "vertices"),
               brief_member(actor, "triangles"), std::to_string(joints), brief_member(actor, "interpolation"),
               brief_member(actor, "transform")});
  }
  table.print(out);
}

}  // namespace

void print_players(std::ostream& out, const Json& players) {
  Table table({"actor", "clip", "state", "time", "duration", "speed", "loop", "range"});
  for (const Json& player : players) {
    table.row({brief_member(player, "actor"), brief_member(player, "clip"), state(player), brief_member(player, "time"),
               brief_member(player, "duration"), brief_member(player, "speed"), brief_member(player, "loop"),
               brief_member(player, "range")});
  }
  if (table.empty()) {
    out << "no actors\n";
  } else {
    table.print(out);
  }
}

void print_scene(std::ostream& out, const Json& scene) {
  const Json& actors = scene.at("actors");
  out << fmt::format("scene {}, revision {}, {} {}\n", brief_member(scene, "scene"), brief_member(scene, "revision"),
                     actors.size(), actors.size() == 1 ? "actor" : "actors");
  for (const char* part : {"camera", "light", "background", "grid"}) {
    if (scene.contains(part)) out << fmt::format("{}: {}\n", part, brief_member(scene, part));
  }
  if (actors.empty()) return;
  out << '\n';
  print_actors(out, actors);
  out << '\n';
  print_players(out, players_of(scene));
  out << '\n';
  print_clips(out, clips_of(scene));
}

Json clips_of(const Json& scene) {
  Json clips = Json::array();
  for (const Json& actor : scene.at("actors")) {
    for (const Json& clip : actor.at("clips")) {
      Json row{{"actor", actor.at("actor")}};
      row.update(clip);
      clips.push_back(std::move(row));
    }
  }
  return clips;
}

std::string player_text(const Json& player) {
  return fmt::format("{} {} {} {} of {} s", brief_member(player, "actor"), brief_member(player, "clip"), state(player),
                     brief_member(player, "time"), brief_member(player, "duration"));
}

}  // namespace tweend::cli
