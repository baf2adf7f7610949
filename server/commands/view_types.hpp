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

struct OrbitParams {
  static constexpr std::string_view kName = "Orbit";
  float azimuth = 0.0F;
  float elevation = 0.0F;
  std::optional<float> distance;
  std::optional<glm::vec3> target;
  static void describe(FieldList<OrbitParams>& f) {
    using T = OrbitParams;
    f.add<&T::azimuth>("azimuth", "Radians from +Z towards +X.");
    f.add<&T::elevation>("elevation", "Radians above the ground.", {.min = -1.5707, .max = 1.5707});
    f.add<&T::distance>("distance", "Metres; as it is if left out.", protocol::kPositive);
    f.add<&T::target>("target", "What it turns about; as it is if left out.");
  }
};

/// What a camera is asked for: by camera.set of the scene's, by pictures and streams of the viewer's own.
struct CameraFields {
  std::optional<glm::vec3> eye, target, up;
  std::optional<float> fov_y, near, far;
  std::optional<OrbitParams> orbit;
  std::optional<bool> fit;

  [[nodiscard]] Status check() const {
    if (eye && orbit) return fail(ErrorCode::InvalidParams, "expected eye or orbit, found both", "orbit");
    return {};
  }
  [[nodiscard]] model::CameraRequest request() const {
    model::CameraRequest r{eye, target, up, fov_y, near, far, {}, fit.value_or(false)};
    if (orbit) r.orbit = {orbit->azimuth, orbit->elevation, orbit->distance, orbit->target};
    return r;
  }
};

template <class T>
void add_camera_fields(FieldList<T>& f) {
  f.template add<&T::eye>("eye", "Where it stands, world space, metres.");
  f.template add<&T::target>("target", "What it looks at.");
  f.template add<&T::up>("up", "Which way is up in the picture.");
  f.template add<&T::fov_y>("fov_y", "The whole vertical angle, radians.", {.min = 0.01, .max = 3.1});
  f.template add<&T::near>("near", "Nearest that is drawn, metres.", protocol::kPositive);
  f.template add<&T::far>("far", "Farthest that is drawn, metres.", protocol::kPositive);
  f.template add<&T::orbit>("orbit", "In place of eye: angles and a distance around the target.");
  f.template add<&T::fit>("fit", "Keep the direction and bring all visible actors wholly into view.");
}

/// `camera` of pictures and streams: what is left out is the scene's camera's.
struct OwnCamera : CameraFields {
  static constexpr std::string_view kName = "OwnCamera";
  static void describe(FieldList<OwnCamera>& f) { add_camera_fields(f); }
};

/// Whether the scene can be seen so: an error names the parameter under `params.camera`.
[[nodiscard]] Status check_own_camera(const OwnCamera& camera, const model::Scene& scene);

[[nodiscard]] inline CameraState camera_state(const model::Camera& c) {
  return {c.eye, c.target, c.up, c.fov_y, c.near, c.far};
}
[[nodiscard]] inline LightState light_state(const model::Light& l) {
  return {l.position, l.ambient, l.diffuse, l.specular, l.shininess};
}

}  // namespace tweend::commands
