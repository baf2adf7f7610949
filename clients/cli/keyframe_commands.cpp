#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <ostream>

#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"

namespace tweend::cli {
namespace {

void show_keyframes(std::ostream& out, const Json&, const Json& result) {
  print_rows(out, result.at("keyframes"), "no keyframes");
  const bool closed = result.value("closed", false);
  out << fmt::format("duration {} s, {}\n", brief_member(result, "duration"), closed ? "closed" : "open");
}

/// An edit of one keyframe: ids are unique, so no clip is named.
Command& add_edit(CommandSet& commands, const char* path, const char* help) {
  return with_actor(with_edit_options(commands.add(path, help)))
      .argument("ID", "keyframe", integer("ID"), "as `keyframe list` says");
}

}  // namespace

void add_keyframe_commands(CommandSet& commands) {
  commands.group("keyframe", "Add, change, move, remove or list keyframes.");
  with_keyframe_content(with_edit_options(with_clip(with_actor(commands.add("keyframe add", "Add a keyframe.")))),
                        commands.in(), false)
      .option("--time", "time", number("SECONDS"), "left out: one second after the last keyframe")
      .needs_one_of({"--capture", "--vertices", "--pose", "--weights"})
      .requests("keyframe.add", "keyframe {keyframe} added at {time} s");
  with_keyframe_content(add_edit(commands, "keyframe update", "Change what a keyframe holds."), commands.in(), true)
      .option("--time", "time", number("SECONDS"), "move it there as well")
      .needs_one_of({"--capture", "--vertices", "--pose", "--weights", "--interpolation", "--easing", "--time"})
      .requests("keyframe.update", "keyframe {keyframe} updated");
  add_edit(commands, "keyframe move", "Move a keyframe in time.")
      .argument("TIME", "time", number("SECONDS"), "media seconds")
      .requests("keyframe.move", "keyframe {keyframe} moved to {time} s");
  add_edit(commands, "keyframe remove", "Remove a keyframe.").requests("keyframe.remove", "keyframe {keyframe} removed");
  with_clip(with_actor(commands.add("keyframe list", "The keyframes of a clip.").in_scene()))
      .requests("keyframe.list", show_keyframes);
}

}  // namespace tweend::cli
