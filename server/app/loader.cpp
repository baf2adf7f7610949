#include "server/app/loader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <memory>
#include <utility>

#include "protocol/json_value.hpp"
#include "protocol/type_info.hpp"
#include "server/commands/command_table.hpp"

namespace tweend::app {
namespace {

using commands::Command;

Result<commands::Params> parameters(const Command& command, const std::string& json, const Limits& limits) {
  TWEEND_ASSIGN(const protocol::JsonValue value, protocol::JsonValue::parse(json, limits));
  return commands::decode_params(command, value);
}

/// Carries out a command to players of the scene main by its method's name and parameters. Waits for it.
Status run_players(const commands::Services& services, std::string_view method, const std::string& json) {
  const Command& command = *commands::find_command(method);
  TWEEND_ASSIGN(const commands::Params params, parameters(command, json, services.limits));
  std::promise<Status> promise;
  services.stage.change_players(
      "main", [&](const stage::PlayersTurn& turn) { return command.players(params.get(), turn); },
      [&promise](const Result<stage::PlayersAnswer>& answer) {
        promise.set_value(answer ? Status() : Status(answer.error()));
      });
  return promise.get_future().get();
}

}  // namespace

std::string actor_name(const std::string& asset) {
  std::string name = asset.substr(asset.find_last_of('/') + 1);
  if (const auto dot = name.find_last_of('.'); dot != std::string::npos && dot > 0) name.resize(dot);
  const auto bad = [](char c) {
    return !((c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '-');
  };
  std::replace_if(name.begin(), name.end(), bad, '_');
  if (name.empty() || name.front() == '.') name.insert(0, 1, '_');
  name.resize(std::min<std::size_t>(name.size(), 64));
  return name;
}

Status run_edit(const commands::Services& services, std::string_view method, const std::string& json) {
  const Command& command = *commands::find_command(method);
  TWEEND_ASSIGN(const commands::Params params, parameters(command, json, services.limits));
  const auto scratch = std::make_shared<commands::EditScratch>();
  std::promise<Status> promise;
  services.stage.edit(
      {"main", std::string(method), {}, {}},
      [&, scratch](stage::Transaction& transaction) {
        commands::EditContext context{services,       transaction, *scratch, "", services.stage.view()->find("main"),
                                      steady_now_us()};
        return command.edit(params.get(), context);
      },
      [&promise](const Result<std::string>& result) { promise.set_value(result ? Status() : Status(result.error())); });
  return promise.get_future().get();
}

Status load_asset(const commands::Services& services, const std::string& asset) {
  const std::string name = actor_name(asset);
  if (services.stage.view()->find("main")->scene->find_actor(name)) return {};
  std::string json = R"({"actor":)";
  protocol::append_json_string(name, json);
  json += R"(,"asset":)";
  protocol::append_json_string(asset, json);
  json += '}';
  return run_edit(services, "actor.add", json);
}

Status show_clip(const commands::Services& services, const std::string& actor, const std::string& clip) {
  std::string actor_json, clip_json;
  protocol::append_json_string(actor, actor_json);
  protocol::append_json_string(clip, clip_json);
  TWEEND_TRY(
      run_players(services, "playback.play", fmt::format(R"({{"actor":{},"clip":{},"time":0}})", actor_json, clip_json)));
  return run_players(services, "playback.pause", fmt::format(R"({{"actor":{}}})", actor_json));
}

Status play_all(const commands::Services& services) { return run_players(services, "playback.play", "{}"); }

}  // namespace tweend::app
