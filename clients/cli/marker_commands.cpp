#include <nlohmann/json.hpp>
#include <ostream>

#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"

namespace tweend::cli {

void add_marker_commands(CommandSet& commands) {
  commands.group("marker", "Name instants of a clip; `events` tells when they are passed.");
  with_edit_options(with_clip(with_actor(commands.add("marker add", "Name an instant of a clip."))))
      .argument("TIME", "time", number("SECONDS"), "media seconds")
      .argument("NAME", "name", text("NAME"), "what it is called")
      .requests("marker.add", "marker {marker} added: {name} at {time} s");
  with_edit_options(with_actor(commands.add("marker remove", "Remove a marker.")))
      .argument("ID", "marker", integer("ID"), "as `marker list` says")
      .requests("marker.remove", "marker {marker} removed");
  with_clip(with_actor(commands.add("marker list", "The markers of a clip.").in_scene()))
      .requests("marker.list", [](std::ostream& out, const Json&, const Json& result) {
        print_rows(out, result.at("markers"), "no markers");
      });
}

}  // namespace tweend::cli
