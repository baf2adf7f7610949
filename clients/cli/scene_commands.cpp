#include <nlohmann/json.hpp>
#include <ostream>

#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/lists.hpp"
#include "clients/cli/scene_text.hpp"

namespace tweend::cli {
namespace {

Json pick_scenes(const Json& result) { return result.at("scenes"); }

/// What a person asks a list of actors for; joints and transforms stand in `scene show`.
Json pick_actors(const Json& scene) {
  Json actors = Json::array();
  for (const Json& actor : scene.at("actors")) {
    Json row = Json::object();
    for (const char* member : {"actor", "source", "vertices", "triangles"}) row[member] = actor.value(member, Json());
    actors.push_back(std::move(row));
  }
  return actors;
}

}  // namespace

void add_scene_commands(CommandSet& commands) {
  lists(commands.add("scenes", "The scenes."), "scene.list", pick_scenes, "scene", "no scenes");
  lists(commands.add("actors", "The actors of the scene.").in_scene(), "scene.describe", pick_actors, "actor", "no actors");
  lists(commands.add("clips", "The clips of the scene's actors.").in_scene(), "scene.describe", clips_of, "clip", "no clips");

  commands.group("scene", "Make, remove, change or show a scene.");
  with_edit_options(commands.add("scene create", "Make an empty scene."))
      .argument("NAME", "scene", text("NAME"), "its name")
      .requests("scene.create", "scene {scene} created");
  with_edit_options(commands.add("scene remove", "Remove a scene with all that is in it; it can't be undone."))
      .argument("NAME", "scene", text("SCENE"), "which scene")
      .requests("scene.remove", "scene {scene} removed");
  with_edit_options(commands.add("scene update", "Change a scene's background and grid."))
      .optional_argument("NAME", "scene", text("SCENE"), "which scene (default: --scene, else main)")
      .option("--background", "background", numbers("R,G,B", {3}), "from 0 to 1")
      .toggle("--grid", "--no-grid", "grid", "draw a grid on the ground")
      .needs_one_of({"--background", "--grid", "--no-grid"})
      .requests("scene.update", "scene updated");
  commands.add("scene show", "What is in a scene: actors, players, clips, camera and light.")
      .in_scene()
      .optional_argument("NAME", "scene", text("SCENE"), "which scene (default: --scene, else main)")
      .requests("scene.describe", [](std::ostream& out, const Json&, const Json& scene) { print_scene(out, scene); });
}

}  // namespace tweend::cli
