#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "clients/cli/arguments.hpp"
#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/picture_options.hpp"
#include "clients/cli/session.hpp"
#include "clients/cli/timing.hpp"

namespace tweend::cli {
namespace {

/// `camera` and `light`: sets what was given, or where nothing was, asks what there is.
Command::Action sets_or_tells(std::string method, std::string part) {
  return [method = std::move(method), part = std::move(part)](Session& session, const Arguments& arguments) {
    const Json params = orbit_with_target(timed_params(session, arguments));
    const bool sets = params.size() > params.count("scene");
    Json result = session.call(sets ? method : "scene.describe", params);
    if (!sets) result = Json{{part, result.at(part)}, {"revision", result.at("revision")}};
    if (const std::string scheduled = scheduled_text(result); !scheduled.empty() && !session.options().json) {
      session.out() << scheduled << '\n';
      return ExitCode::Done;
    }
    session.out() << (session.options().json ? to_line(result) : sentence("{" + part + "}", params, result)) << '\n';
    return ExitCode::Done;
  };
}

}  // namespace

void add_view_commands(CommandSet& commands) {
  with_timing(with_camera(with_edit_options(commands.add("camera", "Set the scene's camera; without options: show it.")), ""))
      .runs(sets_or_tells("camera.set", "camera"));
  with_edit_options(commands.add("light", "Set the scene's light; without options: show it."))
      .option("--position", "position", numbers("X,Y,Z", {3}), "metres")
      .option("--ambient", "ambient", number(), "intensities")
      .option("--diffuse", "diffuse", number(), "")
      .option("--specular", "specular", number(), "")
      .option("--shininess", "shininess", number(), "the highlight's exponent")
      .runs(sets_or_tells("light.set", "light"));
}

}  // namespace tweend::cli
