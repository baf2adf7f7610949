#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "clients/cli/arguments.hpp"
#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/session.hpp"

namespace tweend::cli {
namespace {

constexpr const char* kMethod = "asset.export";

ExitCode export_actor(Session& session, const Arguments& arguments) {
  Json params = arguments.params;
  if (!params.contains("format")) {
    params["format"] = params.at("name").get_ref<const std::string&>().ends_with(".glb") ? "glb" : "obj_sequence";
  }
  const Json result = session.call(kMethod, params);
  session.out() << (session.options().json ? to_line(result) : sentence("{name} saved: {bytes} bytes", params, result)) << '\n';
  return ExitCode::Done;
}

}  // namespace

void add_export_commands(CommandSet& commands) {
  with_actor(commands.add("export", "Save an actor as a new file in the server's first assets folder.").in_scene())
      .argument("NAME", "name", text("NAME"), "NAME.glb, or the folder of an OBJ sequence of the player's clip")
      .option("--format", "format", word("glb|obj_sequence"), "left out: glb for a name that ends with .glb")
      .runs(export_actor);
}

}  // namespace tweend::cli
