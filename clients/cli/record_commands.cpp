#include <nlohmann/json.hpp>
#include <ostream>

#include "clients/cli/arguments.hpp"
#include "clients/cli/command.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/picture_options.hpp"
#include "clients/cli/session.hpp"

namespace tweend::cli {
namespace {

ExitCode start(Session& session, const Arguments& arguments) {
  Json params = picture_params(arguments);
  if (!params.contains("format")) {
    params["format"] = params.at("name").get_ref<const std::string&>().ends_with(".mp4") ? "mp4" : "png_sequence";
  }
  const Json result = session.call("record.start", params);
  session.out() << (session.options().json
                        ? to_line(result)
                        : sentence("recording {record} to {name}: `record stop {record}` ends it", params, result))
                << '\n';
  return ExitCode::Done;
}

}  // namespace

void add_record_commands(CommandSet& commands) {
  commands.group("record", "Record what a scene shows, to a file of the server's.");
  Command& record = commands.add("record start", "Begin a recording.")
                        .in_scene()
                        .argument("NAME", "name", text("NAME"), "NAME.mp4 in the first assets folder, or a new folder for PNGs")
                        .option("--format", "format", word("mp4|png_sequence"), "left out: mp4 for a name that ends with .mp4")
                        .option("--fps", "fps", number("N"), "pictures a second (default 30)");
  with_size(record);
  with_camera(record, "camera/").runs(start);
  commands.add("record stop", "End a recording; returns when its file is whole.")
      .argument("ID", "record", integer("ID"), "as `record start` says")
      .requests("record.stop", "{name} saved: {frames} pictures, {bytes} bytes");
}

}  // namespace tweend::cli
