#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>

#include "clients/cli/arguments.hpp"
#include "clients/cli/clock_offset.hpp"
#include "clients/cli/command.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/histograms.hpp"
#include "clients/cli/lists.hpp"
#include "clients/cli/session.hpp"

namespace tweend::cli {
namespace {

ExitCode ping(Session& session, const Arguments& arguments) {
  // The first question also connects; the quickest of a few says more about the clocks than any one.
  (void)measure_clock(session, 1);
  const auto times = arguments.get<std::uint64_t>("count", 4);
  const ClockOffset clock = measure_clock(session, times);
  if (session.options().json) {
    session.out() << to_line(
                         {{"time_us", clock.server_us}, {"round_trip_us", clock.round_trip_us}, {"offset_us", clock.offset_us}})
                  << '\n';
    return ExitCode::Done;
  }
  session.out() << fmt::format("{} answers in {:.3f} ms (quickest of {}); its clock is {:+.3f} ms from ours\n",
                               session.options().server, static_cast<double>(clock.round_trip_us) * 1e-3,
                               times == 0 ? 1 : times, static_cast<double>(clock.offset_us) * 1e-3);
  return ExitCode::Done;
}

/// Counters are members of the result, perhaps of objects in it: `streams.packets 12`.
void add_figures(Table& table, const std::string& prefix, const Json& figures) {
  for (const auto& [name, value] : figures.items()) {
    if (value.is_object()) {
      add_figures(table, prefix + name + ".", value);
    } else {
      table.row({printable(prefix + name), brief(value)});
    }
  }
}

/// Milliseconds of a histogram of seconds.
std::string quantile_text(const Histogram& durations, double share) {
  const double seconds = quantile(durations, share);
  if (std::isnan(seconds)) return "-";
  if (std::isfinite(seconds)) return fmt::format("{:.2f}", seconds * 1e3);
  const double longest = durations.up_to.size() > 1 ? durations.up_to[durations.up_to.size() - 2].first : 0.0;
  return fmt::format("> {}", number_text(longest * 1e3));
}

void show_stats(std::ostream& out, const Json&, const Json& result) {
  Table table({"figure", "value"});
  Json figures = result;
  const auto durations = take_histograms(figures);
  add_figures(table, "", figures);
  table.print(out);
  if (durations.empty()) return;
  Table rows({"duration", "count", "median ms", "p99 ms"});
  for (const Histogram& duration : durations) {
    rows.row(
        {printable(duration.name), number_text(duration.count()), quantile_text(duration, 0.5), quantile_text(duration, 0.99)});
  }
  out << '\n';
  rows.print(out);
}

Json pick_assets(const Json& result) { return result.at("assets"); }

}  // namespace

void add_server_commands(CommandSet& commands) {
  commands.add("ping", "How long the server takes to answer, and how its clock stands to ours.")
      .option("--count", own("count"), count(), "ask so many times and take the quickest (default 4)")
      .runs(ping);
  commands.add("info", "What the server is and may be asked for.")
      .requests("server.hello", "{server} {version}, protocol {protocol}; your role is {role}; capabilities: {capabilities}");
  commands.add("stats", "The server's counters and gauges; of durations their count, median and p99 (all buckets with --json).")
      .requests("server.stats", show_stats);
  lists(commands.add("assets", "The files in the assets folders."), "asset.list", pick_assets, "name", "no assets");
}

}  // namespace tweend::cli
