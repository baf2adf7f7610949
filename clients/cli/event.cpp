#include "clients/cli/event.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "clients/cli/connection.hpp"
#include "clients/cli/failure.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/scene_text.hpp"
#include "clients/cli/session.hpp"

namespace tweend::cli {
namespace {

std::string players_text(const Json& players) {
  std::string text;
  for (const Json& player : players) {
    if (!text.empty()) text += "; ";
    text += player_text(player);
  }
  return text;
}

/// Which marker of which clip: `scene main, box walk: left at 0.5 s`.
std::string crossing_text(const Json& params) {
  return fmt::format("scene {}, {} {}: {} at {} s", brief_member(params, "scene"), brief_member(params, "actor"),
                     brief_member(params, "clip"), brief_member(params, "name"), brief_member(params, "time"));
}

std::string params_text(const Json& method, const Json& params) {
  if (params.contains("players")) {
    return fmt::format("scene {}, {}", brief_member(params, "scene"), players_text(params.at("players")));
  }
  return method == "marker.crossed" ? crossing_text(params) : brief(params);
}

}  // namespace

Json next_event(Session& session, Deadline deadline) {
  for (;;) {
    const Message message = session.next(deadline);
    if (!message.packet) return parse_event(message.line);
  }
}

Json parse_event(const std::string& line) {
  Json event = Json::parse(line, nullptr, false);
  if (!event.is_object() || !event.contains("method") || !event.at("method").is_string()) {
    throw NoServer(fmt::format("expected an event, the server sent '{:.60}'", printable(line)));
  }
  if (!event.contains("params")) event["params"] = Json::object();
  return event;
}

std::string event_line(const Json& event, bool json) {
  const Json& params = event.at("params");
  if (json) return to_line({{"method", event.at("method")}, {"params", params}});
  return fmt::format("{:<16}  {}", brief(event.at("method")), params_text(event.at("method"), params));
}

bool concerns(const Json& event, std::string_view actor) {
  const Json& params = event.at("params");
  const auto names_it = [&](const Json& object) { return brief_member(object, "actor") == actor; };
  if (actor.empty() || names_it(params)) return true;
  const Json players = params.value("players", Json::array());
  return std::any_of(players.begin(), players.end(), names_it);
}

}  // namespace tweend::cli
