#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/timing.hpp"

namespace tweend::cli {

void add_actor_commands(CommandSet& commands) {
  Command& add =
      commands.add("add", "Add an actor, from an asset, a mesh or a skeleton.")
          .argument("NAME", "actor", text("NAME"), "what it is to be called")
          .option("--asset", "asset", text("ASSET"), "a file in the assets folders, or the folder of a sequence")
          .option("--mesh", "mesh", json_file(commands.in()), "JSON {positions, normals?, indices}, - for standard input")
          .option("--skeleton", "skeleton", json_file(commands.in()),
                  "JSON {joints: [{name, parent?, translation?, rotation?, scale?}]}, - for standard input")
          .option("--fps", "fps", number(), "of a sequence's frame numbers (default 24)")
          .flag("--closed", "closed", "blend from the last keyframe back to the first")
          .option("--duration", "duration", number("SECONDS"), "of the clip")
          .exclusive({"--asset", "--mesh", "--skeleton"})
          .needs_one_of({"--asset", "--mesh", "--skeleton"});
  with_edit_options(with_transform(with_interpolation(add, false)))
      .requests("actor.add", "actor {actor} added: {vertices} vertices, {joints} joints, clips {clips}");

  with_edit_options(commands.add("remove", "Remove an actor."))
      .argument("NAME", "actor", text("ACTOR"), "which actor")
      .requests("actor.remove", "actor {actor} removed");

  commands.group("actor", "Change an actor.");
  Command& update =
      commands.add("actor update", "Change how an actor stands, moves and looks; what is left out stays.")
          .optional_argument("NAME", "actor", text("ACTOR"), "which actor; may be left out where the scene has one")
          .toggle("--visible", "--hidden", "visible", "show it")
          .toggle("--show-skeleton", "--hide-skeleton", "show_skeleton", "draw its joints and bones over the mesh")
          .option("--spin", "spin", number(), "radians a second about +Y while playing");
  with_timing(with_edit_options(with_transform(with_interpolation(update, true))))
      .needs_one_of({"--translation", "--rotation", "--rotate-y", "--scale", "--interpolation", "--visible", "--hidden",
                     "--show-skeleton", "--hide-skeleton", "--spin"})
      .requests("actor.update", "actor updated");
}

}  // namespace tweend::cli
