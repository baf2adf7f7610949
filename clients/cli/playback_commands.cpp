#include <nlohmann/json.hpp>
#include <ostream>

#include "clients/cli/command.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/scene_text.hpp"

namespace tweend::cli {
namespace {

void show_players(std::ostream& out, const Json&, const Json& result) { print_players(out, result.at("players")); }

Command& add_playback(CommandSet& commands, const char* name, const char* help) {
  return commands.add(name, help)
      .in_scene()
      .option("--actor", "actor", text("ACTOR"), "which actor; left out: every one, in lockstep");
}

Command& with_speed_and_loop(Command& command) {
  return command.option("--speed", "speed", number(), "1 is as recorded; negative: backwards")
      .option("--loop", "loop", word("once|repeat|ping_pong"), "what happens at the end");
}

}  // namespace

void add_playback_commands(CommandSet& commands) {
  with_speed_and_loop(add_playback(commands, "play", "Play; what is left out stays as it is."))
      .option("--clip", "clip", text("CLIP"), "which clip; another one starts at its start")
      .option("--time", "time", number("SECONDS"), "from here")
      .requests("playback.play", show_players);
  add_playback(commands, "pause", "Stand still where it is.").requests("playback.pause", show_players);
  add_playback(commands, "stop", "Stand still at the start of the range.").requests("playback.stop", show_players);
  add_playback(commands, "seek", "Move the playhead.")
      .argument("TIME", "time", number("SECONDS"), "media seconds")
      .requests("playback.seek", show_players);
  add_playback(commands, "step", "Pause, then move by seconds or keyframes: without either to the next keyframe.")
      .option("--seconds", "seconds", number(), "so far; negative: back")
      .option("--keyframes", "keyframes", integer(), "so many keyframes; negative: back")
      .exclusive({"--seconds", "--keyframes"})
      .otherwise("seconds", "keyframes", 1)
      .requests("playback.step", show_players);
  with_speed_and_loop(add_playback(commands, "set", "Change how the players play, whether they do or not."))
      .option("--range", "range", numbers("IN,OUT", {2}), "play only this part, in media seconds")
      .needs_one_of({"--speed", "--loop", "--range"})
      .requests("playback.set", show_players);
  add_playback(commands, "status", "What the players are doing.").requests("playback.get", show_players);
}

}  // namespace tweend::cli
