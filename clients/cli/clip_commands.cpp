#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/families.hpp"

namespace tweend::cli {
namespace {

Command& with_settings(Command& command, bool clearable) {
  ValueKind duration = number("SECONDS");
  return with_interpolation(command, clearable)
      .option("--duration", "duration", clearable ? or_none(duration) : duration, "beyond the last keyframe")
      .toggle("--closed", "--open", "closed", "blend from the last keyframe back to the first");
}

Command& add_edit(CommandSet& commands, const char* path, const char* shape, const char* help) {
  return with_actor(with_edit_options(commands.add(path, help))).argument("NAME", "clip", text(shape), "the clip's name");
}

}  // namespace

void add_clip_commands(CommandSet& commands) {
  commands.group("clip", "Make, change or remove clips.");
  with_settings(add_edit(commands, "clip create", "NAME", "Make a clip."), false)
      .option("--keys", "keys", integers("ID,ID,…"), "a cue: these keyframes of another clip, evenly spaced over the duration")
      .option("--type", "type", word("vertex|skeletal"), "what its keyframes hold; left out: the first one says")
      .requests("clip.create", "clip {clip} created");
  with_settings(add_edit(commands, "clip update", "CLIP", "Change a clip; what is left out stays."), true)
      .needs_one_of({"--closed", "--open", "--duration", "--interpolation"})
      .requests("clip.update", "clip {clip} updated");
  add_edit(commands, "clip remove", "CLIP", "Remove a clip.").requests("clip.remove", "clip {clip} removed");
}

}  // namespace tweend::cli
