#include "render/h264_encoder.hpp"
#include "server/commands/command_table.hpp"

namespace tweend::commands {
namespace {

struct HelloParams {
  static constexpr std::string_view kName = "HelloParams";
  std::optional<std::string> token;
  std::optional<std::string> client;
  static void describe(FieldList<HelloParams>& f) {
    f.add<&HelloParams::token>("token", "Who you are; not looked at while the server runs with --no-auth.");
    f.add<&HelloParams::client>("client", "What you are, for the log: a name and version.");
  }
};

struct HelloResult {
  static constexpr std::string_view kName = "Hello";
  std::string server = "tweend";
  std::string version = TWEEND_VERSION;
  std::int64_t protocol = 1;
  std::string role = std::string(role_name(Role::Admin));
  std::vector<std::string> capabilities{"line",     "websocket", "http",         "events",       "assets:obj",
                                        "pose:f32", "pose:q16",  "vertices:f32", "vertices:q16", "vertices:meshopt"};
  static void describe(FieldList<HelloResult>& f) {
    using T = HelloResult;
    f.add<&T::server>("server", "Always tweend.");
    f.add<&T::version>("version", "Of the server.");
    f.add<&T::protocol>("protocol", "Version of the protocol.");
    f.add<&T::role>("role", "What you may do: view, control or admin.");
    f.add<&T::capabilities>("capabilities", "What this server can do.");
  }
};

struct NoParams {
  static constexpr std::string_view kName = "NoParams";
  static void describe(FieldList<NoParams>&) {}
};

struct PingResult {
  static constexpr std::string_view kName = "Ping";
  std::int64_t time_us = 0;
  static void describe(FieldList<PingResult>& f) {
    f.add<&PingResult::time_us>("time_us", "The server's steady clock, microseconds.");
  }
};

Result<HelloResult> hello(const HelloParams&, const QueryContext& context) {
  HelloResult result;
  if (context.services.renderer.device()) {
    for (const char* encoding : {"frames:jpeg", "frames:png", "frames:rgba"}) result.capabilities.emplace_back(encoding);
    if (render::has_h264()) result.capabilities.emplace_back("frames:h264");
  }
  return result;
}

Result<PingResult> ping(const NoParams&, const QueryContext& context) { return PingResult{context.now_us}; }

Result<std::map<std::string, double>> stats(const NoParams&, const QueryContext& context) {
  std::map<std::string, double> values;
  for (const Metrics::Reading& r : context.services.metrics.read()) values[r.name] = r.value;
  for (const auto& r : context.services.hub.meters().read()) values[r.name] = static_cast<double>(r.value);
  return values;
}

Result<protocol::JsonText> discover(const NoParams&, const QueryContext&) { return protocol::JsonText{openrpc_document()}; }

}  // namespace

void add_server_commands(std::vector<Command>& t) {
  t.push_back(query_command<&hello>("server.hello", Role::View, "Who is there, and what you may do."));
  t.push_back(query_command<&ping>("server.ping", Role::View, "The steady clock's reading; never waits behind other requests.",
                                   Shape::Ping));
  t.push_back(query_command<&stats>("server.stats", Role::View, "All counters and gauges, named as in /metrics."));
  t.push_back(query_command<&discover>("rpc.discover", Role::View, "This server's methods as an OpenRPC document."));
}

}  // namespace tweend::commands
