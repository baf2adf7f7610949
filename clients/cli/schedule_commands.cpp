#include <nlohmann/json.hpp>
#include <ostream>

#include "clients/cli/command.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"

namespace tweend::cli {

void add_schedule_commands(CommandSet& commands) {
  commands.group("schedule", "Commands that wait for a reading of the server's clock, as --at makes them.");
  commands.add("schedule list", "What waits.")
      .in_scene()
      .requests("schedule.list", [](std::ostream& out, const Json&, const Json& result) {
        print_rows(out, result.at("scheduled"), "nothing waits");
      });
  commands.add("schedule cancel", "Take a command back.")
      .argument("ID", "scheduled", integer("ID"), "as `schedule list` says")
      .requests("schedule.cancel", "{scheduled} cancelled");
}

}  // namespace tweend::cli
