#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"

namespace tweend::cli {
namespace {

/// Where a joint stands: relative to its parent as it is told, in model space from the matrix's last column.
void add_row(Table& table, const Json& joint) {
  if (!joint.contains("matrix")) {
    return table.row_of(joint, {"name", "translation", "rotation", "scale"});
  }
  Json place = Json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) place.push_back(joint.at("matrix").at(12 + axis));
  table.row({brief_member(joint, "name"), brief(place)});
}

void show_pose(std::ostream& out, const Json&, const Json& result) {
  const Json& joints = result.at("joints");
  out << fmt::format("{} {} at {} s\n", joints.size(), joints.size() == 1 ? "joint" : "joints", brief_member(result, "time"));
  const bool in_model = !joints.empty() && joints.front().contains("matrix");
  Table table(in_model ? std::vector<std::string>{"joint", "place"}
                       : std::vector<std::string>{"joint", "translation", "rotation", "scale"});
  for (const Json& joint : joints) add_row(table, joint);
  if (!table.empty()) table.print(out);
  const Json weights = result.value("weights", Json::array());
  if (!weights.empty()) out << fmt::format("weights {}\n", brief(weights));
}

}  // namespace

void add_pose_commands(CommandSet& commands) {
  commands.group("pose", "Show a live pose, or ask where the joints are.");
  with_actor(
      commands.add("pose set", "Show a live pose over the player's; joints that are not named stay the player's.").in_scene())
      .argument("POSE", "pose", json_or_file(commands.in()),
                "JSON {joint: {rotation?, translation?, scale?}, ...}, or @FILE, @- for standard input")
      .requests("pose.set", "pose set");
  with_actor(commands.add("pose clear", "Show the player's pose again.").in_scene()).requests("pose.clear", "pose cleared");
  with_clip(with_actor(commands.add("pose sample", "Every joint at a time, or as it is shown now.").in_scene()))
      .option("--time", "time", number("SECONDS"), "left out: now")
      .option("--space", "space", word("local|model"), "relative to the parent (default), or to the model")
      .requests("pose.sample", show_pose);
}

}  // namespace tweend::cli
