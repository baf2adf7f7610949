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

/// An orbit looks at a target of its own: where both are given, --target is meant for it.
Json orbit_with_target(Json params) {
  if (params.contains("orbit") && params.contains("target")) {
    params["orbit"]["target"] = params["target"];
    params.erase("target");
  }
  return params;
}

/// `camera` and `light`: sets what was given, or where nothing was, asks what there is.
Command::Action sets_or_tells(std::string method, std::string part) {
  return [method = std::move(method), part = std::move(part)](Session& session, const Arguments& arguments) {
    const Json params = orbit_with_target(arguments.params);
    const bool sets = params.size() > params.count("scene");
    Json result = session.call(sets ? method : "scene.describe", params);
    if (!sets) result = Json{{part, result.at(part)}, {"revision", result.at("revision")}};
    session.out() << (session.options().json ? to_line(result) : sentence("{" + part + "}", params, result)) << '\n';
    return ExitCode::Done;
  };
}

}  // namespace

void add_view_commands(CommandSet& commands) {
  with_edit_options(commands.add("camera", "Set the scene's camera; without options: show it."))
      .option("--eye", "eye", numbers("X,Y,Z", {3}), "where it stands, metres")
      .option("--target", "target", numbers("X,Y,Z", {3}), "what it looks at")
      .option("--up", "up", numbers("X,Y,Z", {3}), "what is up")
      .option("--fov-y", "fov_y", number("RADIANS"), "the whole vertical angle")
      .option("--near", "near", number("METRES"), "nothing nearer is drawn")
      .option("--far", "far", number("METRES"), "nothing further away is drawn")
      .option("--orbit", "orbit", orbit(), "around the target, in radians and metres")
      .flag("--fit", "fit", "keep the direction and bring all visible actors into view")
      .exclusive({"--eye", "--orbit", "--fit"})
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
