#pragma once

#include "server/commands/wire_types.hpp"
#include "server/model/camera.hpp"

namespace tweend::commands {

struct CameraState {
  static constexpr std::string_view kName = "Camera";
  glm::vec3 eye{};
  glm::vec3 target{};
  glm::vec3 up{};
  float fov_y = 0.0F;
  float near = 0.0F;
  float far = 0.0F;
  static void describe(FieldList<CameraState>& f) {
    using T = CameraState;
    f.add<&T::eye>("eye", "Where it stands, world space, metres.");
    f.add<&T::target>("target", "What it looks at.");
    f.add<&T::up>("up", "Which way is up in the picture.");
    f.add<&T::fov_y>("fov_y", "The whole vertical angle, radians.");
    f.add<&T::near>("near", "Nearest that is drawn, metres.");
    f.add<&T::far>("far", "Farthest that is drawn, metres.");
  }
};

struct LightState {
  static constexpr std::string_view kName = "Light";
  glm::vec3 position{};
  float ambient = 0.0F;
  float diffuse = 0.0F;
  float specular = 0.0F;
  float shininess = 0.0F;
  static void describe(FieldList<LightState>& f) {
    using T = LightState;
    f.add<&T::position>("position", "World space, metres.");
    f.add<&T::ambient>("ambient", "Intensity from everywhere.");
    f.add<&T::diffuse>("diffuse", "Intensity of matt reflection.");
    f.add<&T::specular>("specular", "Intensity of the highlight.");
    f.add<&T::shininess>("shininess", "Exponent of the highlight.");
  }
};

[[nodiscard]] inline CameraState camera_state(const model::Camera& c) {
  return {c.eye, c.target, c.up, c.fov_y, c.near, c.far};
}
[[nodiscard]] inline LightState light_state(const model::Light& l) {
  return {l.position, l.ambient, l.diffuse, l.specular, l.shininess};
}

}  // namespace tweend::commands
