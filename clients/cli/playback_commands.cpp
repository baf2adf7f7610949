#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "clients/cli/arguments.hpp"
#include "clients/cli/command.hpp"
#include "clients/cli/failure.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/scene_text.hpp"
#include "clients/cli/session.hpp"
#include "clients/cli/timing.hpp"

namespace tweend::cli {
namespace {

void show_players(std::ostream& out, const Json&, const Json& result) { print_players(out, result.at("players")); }

Command& add_untimed(CommandSet& commands, const char* name, const char* help) {
  return commands.add(name, help)
      .in_scene()
      .option("--actor", "actor", text("ACTOR"), "which actor; left out: every one, in lockstep");
}

Command& add_playback(CommandSet& commands, const char* name, const char* help) {
  return with_timing(add_untimed(commands, name, help));
}

/// `CLIP`, `CLIP:REPEAT` or `CLIP:REPEAT:FADE` as an entry of playback.queue.
Json queue_entry(const std::string& text) {
  const std::size_t first = text.find(':');
  Json entry{{"clip", text.substr(0, first)}};
  if (first == std::string::npos) return entry;
  const std::size_t second = text.find(':', first + 1);
  entry["repeat"] = count().read(text.substr(first + 1, second - first - 1));
  if (second != std::string::npos) entry["fade"] = seconds().read(text.substr(second + 1));
  return entry;
}

void add_queue(CommandSet& commands) {
  add_playback(commands, "queue", "Play clips one after another, without a gap.")
      .more_arguments("CLIPS", own("clips"), "CLIP[:REPEAT[:FADE]] …", "how often each, and in how many seconds it fades in")
      .option("--loop", own("loop"), word("once|repeat|ping_pong"), "what one repeat is: there, or there and back")
      .runs([](Session& session, const Arguments& arguments) {
        const auto texts = arguments.get<std::vector<std::string>>("clips", {});
        if (texts.empty()) throw Usage("nothing to play: expected CLIP[:REPEAT[:FADE]] …");
        Json params = timed_params(session, arguments);
        for (const std::string& text : texts) {
          Json& entry = params["clips"].emplace_back(queue_entry(text));
          if (arguments.has("loop")) entry["loop"] = arguments.own.at("loop");
        }
        const Json result = session.call("playback.queue", params);
        if (session.options().json) {
          session.out() << to_line(result) << '\n';
        } else if (const std::string scheduled = scheduled_text(result); !scheduled.empty()) {
          session.out() << scheduled << '\n';
        } else {
          show_players(session.out(), params, result);
        }
        return ExitCode::Done;
      });
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
      .option("--fade", "fade", seconds(), "replace what is shown in this time")
      .requests("playback.play", show_players);
  add_queue(commands);
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
  add_untimed(commands, "status", "What the players are doing.").requests("playback.get", show_players);
}

}  // namespace tweend::cli
