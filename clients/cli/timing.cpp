#include "clients/cli/timing.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "clients/cli/arguments.hpp"
#include "clients/cli/clock_offset.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/session.hpp"

namespace tweend::cli {
namespace {

/// A reading as an integer, or `+SECONDS` as a number with a fraction.
ValueKind moment() {
  return {"READING or +SECONDS", [](const std::string& found) {
            if (!found.starts_with('+')) return integer().read(found);
            return Json{{"after_s", seconds().read(found.substr(1))}};
          }};
}

}  // namespace

Command& with_timing(Command& command) {
  return command.option("--at", own("at"), moment(), "carry it out as of this reading of the server's clock, in microseconds")
      .option("--late", "late", word("run|error"),
              "what becomes of it where that is past: run it now (the default), or refuse");
}

Json timed_params(Session& session, const Arguments& arguments) {
  Json params = arguments.params;
  if (!arguments.has("at")) return params;
  const Json& at = arguments.own.at("at");
  if (!at.is_object()) {
    params["at_us"] = at;
    return params;
  }
  const auto server_us = session.call("server.ping", Json::object()).at("time_us").get<std::int64_t>();
  params["at_us"] = server_us + std::llround(at.at("after_s").get<double>() * 1e6);
  return params;
}

std::string scheduled_text(const Json& result) {
  if (!result.is_object() || !result.contains("scheduled") || !result.contains("at_us")) return "";
  return fmt::format("scheduled as {} for the reading {}", brief_member(result, "scheduled"), result.at("at_us").dump());
}

}  // namespace tweend::cli
