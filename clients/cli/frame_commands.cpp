#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <string_view>

#include "clients/cli/arguments.hpp"
#include "clients/cli/command.hpp"
#include "clients/cli/failure.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/picture.hpp"
#include "clients/cli/picture_options.hpp"
#include "clients/cli/session.hpp"
#include "clients/cli/write_file.hpp"
#include "protocol/base64.hpp"

namespace tweend::cli {
namespace {

constexpr const char* kMethod = "frame.render";

/// A name whose extension says which kind of picture, or `-`.
ValueKind picture_file() {
  return {"FILE", [](const std::string& found) {
            if (found != "-" && !format_of_file(found)) {
              throw Usage(
                  fmt::format("expected a name that ends with .png or with .jpg or .jpeg, or - for PNG on standard "
                              "output, found '{}'",
                              found));
            }
            return Json(found);
          }};
}

std::string decode_picture(const Json& result, PictureFormat format) {
  const auto bytes = protocol::decode_base64(result.at("base64").get_ref<const std::string&>());
  if (!bytes) throw NoServer(fmt::format("{} sent a broken picture: {}", kMethod, bytes.error().message));
  std::string picture(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  check_picture(picture, format, kMethod);
  return picture;
}

void write_to_output(std::ostream& out, std::string_view picture) {
  out << picture << std::flush;
  if (!out)
    throw Failure(ExitCode::Refused, "can't write to standard output: expected a place for " + bytes_text(picture.size()));
}

/// What was stored where: a sentence, or what the server answered with the file in the picture's place.
std::string stored_text(bool json, const std::string& file, std::size_t bytes, Json result) {
  if (!json) {
    return fmt::format("{}: {} x {}, {}, at {} s", printable(file), brief_member(result, "width"),
                       brief_member(result, "height"), bytes_text(bytes), brief_member(result, "time"));
  }
  result.erase("base64");
  result["file"] = file;
  result["bytes"] = bytes;
  return to_line(result);
}

ExitCode render(Session& session, const Arguments& arguments) {
  const auto file = arguments.get<std::string>("file", "");
  const bool to_output = file == "-";
  if (to_output && session.options().json) throw Usage("--json: the picture goes to standard output; name a file for it");
  if (to_output) session.expect_no_terminal("a picture");
  const PictureFormat format = format_of_file(file).value_or(PictureFormat::Png);
  Json params = picture_params(arguments);
  params["format"] = name_of(format);
  const Json result = session.call(kMethod, params);
  const std::string picture = decode_picture(result, format);
  if (to_output) {
    write_to_output(session.out(), picture);
  } else {
    write_file(file, picture);
    session.out() << stored_text(session.options().json, file, picture.size(), result) << '\n';
  }
  return ExitCode::Done;
}

}  // namespace

void add_frame_commands(CommandSet& commands) {
  Command& frame = commands.add("frame", "Render one picture of the scene into a file.")
                       .in_scene()
                       .argument("FILE", own("file"), picture_file(), "a .png or a .jpg; - writes PNG to standard output")
                       .option("--time", "time", number("SECONDS"), "media seconds; left out: now");
  with_picture(frame).runs(render);
}

}  // namespace tweend::cli
