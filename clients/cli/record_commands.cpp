#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <string_view>

#include "clients/cli/arguments.hpp"
#include "clients/cli/command.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/lists.hpp"
#include "clients/cli/picture_options.hpp"
#include "clients/cli/session.hpp"

namespace tweend::cli {
namespace {

ExitCode print(Session& session, const Json& params, const Json& result, std::string_view pattern) {
  session.out() << (session.options().json ? to_line(result) : sentence(pattern, params, result)) << '\n';
  return ExitCode::Done;
}

ExitCode start(Session& session, const Arguments& arguments) {
  Json params = picture_params(arguments);
  // A name with an extension is meant to be a file: whether it can be one is for the server to say.
  const bool is_folder = params.at("name").get_ref<const std::string&>().find('.') == std::string::npos;
  if (is_folder && !params.contains("format")) params["format"] = "png_sequence";
  const Json result = session.call("record.start", params);
  return print(session, params, result, "recording {record} to {name}: `record stop {record}` ends it");
}

/// The server answers once all pictures are made, which may well take as long as the recording has.
ExitCode stop(Session& session, const Arguments& arguments) {
  const Json result = session.call_patiently("record.stop", arguments.params);
  return print(session, arguments.params, result, "{name} saved: {frames} pictures, {bytes} bytes");
}

Json pick_recordings(const Json& result) { return result.at("recordings"); }

}  // namespace

void add_record_commands(CommandSet& commands) {
  commands.group("record", "Record what a scene shows, to a file of the server's.");
  Command& record =
      commands.add("record start", "Begin a recording.")
          .in_scene()
          .argument("NAME", "name", text("NAME"), "NAME.mp4 in the first assets folder, or a new folder for PNGs")
          .option("--format", "format", word("mp4|png_sequence"), "left out: png_sequence for a name without a dot, else mp4")
          .option("--fps", "fps", number("N"), "pictures a second (default 30)");
  with_size(record);
  with_camera(record, "camera/").runs(start);
  commands.add("record stop", "End a recording; returns when its file is whole, however long that takes.")
      .argument("ID", "record", integer("ID"), "as `record start` or `record list` says")
      .runs(stop);
  lists(commands.add("record list", "The recordings that run or are being finished."), "record.list", pick_recordings,
        "recording", "no recordings");
}

}  // namespace tweend::cli
