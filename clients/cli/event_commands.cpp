#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

#include "clients/cli/arguments.hpp"
#include "clients/cli/command.hpp"
#include "clients/cli/connection.hpp"
#include "clients/cli/event.hpp"
#include "clients/cli/failure.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/session.hpp"

namespace tweend::cli {
namespace {

ExitCode print_events(Session& session, const Arguments& arguments) {
  (void)session.call("events.subscribe", arguments.params);
  const auto count = arguments.get<std::uint64_t>("count", 0);
  for (std::uint64_t printed = 0; count == 0 || printed < count; ++printed) {
    if (!session.print_line(event_line(next_event(session, {}), session.options().json))) break;
  }
  return ExitCode::Done;
}

bool any_playing(Session& session, const Json& params) {
  const Json players = session.call("playback.get", params).at("players");
  return std::any_of(players.begin(), players.end(), [](const Json& player) { return player.value("playing", false); });
}

ExitCode wait_for(const char* method, Session& session, const Arguments& arguments) {
  const auto actor = arguments.get<std::string>("actor", "");
  const auto timeout_s = arguments.get<double>("timeout", -1.0);
  const Deadline deadline = timeout_s < 0.0 ? Deadline() : deadline_in(timeout_s);
  (void)session.call("events.subscribe", arguments.params);
  if (arguments.has("if_playing")) {  // after subscribing, or an end in between would be missed
    Json params = arguments.params;
    if (!actor.empty()) params["actor"] = actor;
    if (!any_playing(session, params)) return ExitCode::Done;
  }
  try {
    for (;;) {
      const Json event = next_event(session, deadline);
      if (event.at("method") != method || !concerns(event, actor)) continue;
      (void)session.print_line(event_line(event, session.options().json));
      return ExitCode::Done;
    }
  } catch (const TimedOut&) {
    throw Failure(ExitCode::Refused, fmt::format("no {} within {} s", method, timeout_s));
  }
}

Command& add_wait(CommandSet& commands, const char* name, const char* method, const char* help) {
  Command& command = commands.add(name, help)
                         .in_scene()
                         .option("--actor", own("actor"), text("ACTOR"), "only of this actor")
                         .option("--timeout", own("timeout"), seconds(), "exit with 1 after so long (default: wait for ever)");
  command.runs([method](Session& session, const Arguments& arguments) { return wait_for(method, session, arguments); });
  return command;
}

}  // namespace

void add_event_commands(CommandSet& commands) {
  commands.add("events", "Print what happens in the scene, a line an event, until interrupted.")
      .in_scene()
      .option("--count", own("count"), count(), "stop after so many")
      .runs(print_events);
  commands.group("wait", "Wait until something happens; each waits for the next time, whatever happened before.");
  add_wait(commands, "wait ended", "playback.ended", "Wait for the next end of a playback.")
      .flag("--if-playing", own("if_playing"), "return at once if no player is playing");
  add_wait(commands, "wait changed", "playback.changed", "Wait until a player is next played, paused, sought or set.");
  add_wait(commands, "wait marker", "marker.crossed", "Wait until a player next passes a marker of its clip.");
  add_wait(commands, "wait edited", "scene.changed", "Wait for the next edit.");
}

}  // namespace tweend::cli
