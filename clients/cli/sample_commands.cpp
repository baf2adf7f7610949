#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "clients/cli/arguments.hpp"
#include "clients/cli/bounds.hpp"
#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/session.hpp"

namespace tweend::cli {
namespace {

void print_vertices(std::ostream& out, const Json& sample, std::uint64_t rows) {
  const Json& positions = sample.at("positions");
  const Json& normals = sample.at("normals");
  Table table({"vertex", "x", "y", "z", "nx", "ny", "nz"});
  for (std::size_t v = 0; v < std::min<std::uint64_t>(rows, positions.size() / 3); ++v) {
    std::vector<std::string> cells{std::to_string(v)};
    for (std::size_t axis = 0; axis < 3; ++axis) cells.push_back(brief(positions.at(3 * v + axis)));
    for (std::size_t axis = 0; axis < 3; ++axis) cells.push_back(brief(normals.at(3 * v + axis)));
    table.row(std::move(cells));
  }
  if (!table.empty()) table.print(out);
}

ExitCode sample_vertices(Session& session, const Arguments& arguments) {
  const Json sample = session.call("vertices.sample", arguments.params);
  if (session.options().json) {
    session.out() << to_line(sample) << '\n';
    return ExitCode::Done;
  }
  const auto positions = sample.at("positions").get<std::vector<float>>();
  session.out() << fmt::format("{} vertices at {} s, {}\n", brief_member(sample, "count"), brief_member(sample, "time"),
                               bounds_text(positions));
  if (sample.contains("indices")) session.out() << fmt::format("{} triangles\n", sample.at("indices").size() / 3);
  print_vertices(session.out(), sample, arguments.get<std::uint64_t>("rows", 5));
  return ExitCode::Done;
}

}  // namespace

void add_sample_commands(CommandSet& commands) {
  with_clip(with_actor(commands.add("vertices", "The vertices that an actor shows, in model space.").in_scene()))
      .option("--time", "time", number("SECONDS"), "left out: now")
      .flag("--indices", "indices", "the triangles as well")
      .option("--rows", own("rows"), count(), "print so many vertices (default 5; --json has them all)")
      .runs(sample_vertices);
}

}  // namespace tweend::cli
