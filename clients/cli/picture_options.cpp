#include "clients/cli/picture_options.hpp"

#include <nlohmann/json.hpp>

#include "clients/cli/arguments.hpp"

namespace tweend::cli {

Command& with_camera(Command& command, const std::string& into) {
  command.option("--eye", into + "eye", numbers("X,Y,Z", {3}), "where the camera stands, metres")
      .option("--target", into + "target", numbers("X,Y,Z", {3}), "what it looks at")
      .option("--up", into + "up", numbers("X,Y,Z", {3}), "what is up")
      .option("--fov-y", into + "fov_y", number("RADIANS"), "the whole vertical angle")
      .option("--near", into + "near", number("METRES"), "nothing nearer is drawn")
      .option("--far", into + "far", number("METRES"), "nothing further away is drawn")
      .option("--orbit", into + "orbit", orbit(), "around the target, in radians and metres")
      .option("--azimuth", into + "orbit/azimuth", number("RADIANS"), "the numbers of --orbit one by one")
      .option("--elevation", into + "orbit/elevation", number("RADIANS"), "")
      .option("--distance", into + "orbit/distance", number("METRES"), "")
      .flag("--fit", into + "fit", "keep the direction and bring all visible actors into view")
      .exclusive({"--eye", "--orbit", "--fit"});
  for (const char* part : {"--azimuth", "--elevation", "--distance"}) {
    for (const char* other : {"--eye", "--orbit", "--fit"}) command.exclusive({part, other});
  }
  return command;
}

Command& with_size(Command& command) {
  return command.option("--width", "width", count("PIXELS"), "(default 1280)")
      .option("--height", "height", count("PIXELS"), "(default 720)")
      .option("--size", own("size"), size(), "both")
      .exclusive({"--size", "--width"})
      .exclusive({"--size", "--height"});
}

Command& with_picture(Command& command) {
  with_size(command).option("--quality", "quality", count("1-100"), "of a JPEG (default 80)");
  return with_camera(command, "camera/");
}

Json orbit_with_target(Json camera) {
  if (camera.contains("orbit") && camera.contains("target")) {
    camera["orbit"]["target"] = camera["target"];
    camera.erase("target");
  }
  return camera;
}

Json picture_params(const Arguments& arguments) {
  Json params = arguments.params;
  params.update(arguments.get("size", Json::object()));
  if (params.contains("camera")) params["camera"] = orbit_with_target(params.at("camera"));
  return params;
}

}  // namespace tweend::cli
