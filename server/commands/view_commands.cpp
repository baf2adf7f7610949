#include <cmath>
#include <glm/geometric.hpp>

#include "server/commands/command_table.hpp"
#include "server/commands/view_types.hpp"

namespace tweend::commands {
namespace {

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

struct CameraParams : EditTarget {
  static constexpr std::string_view kName = "CameraParams";
  std::optional<glm::vec3> eye, target, up;
  std::optional<float> fov_y, near, far;
  std::optional<OrbitParams> orbit;
  std::optional<bool> fit;
  static void describe(FieldList<CameraParams>& f) {
    using T = CameraParams;
    add_edit_fields(f);
    f.add<&T::eye>("eye", "Where it stands, world space, metres.");
    f.add<&T::target>("target", "What it looks at.");
    f.add<&T::up>("up", "Which way is up in the picture.");
    f.add<&T::fov_y>("fov_y", "The whole vertical angle, radians.", {.min = 0.01, .max = 3.1});
    f.add<&T::near>("near", "Nearest that is drawn, metres.", protocol::kPositive);
    f.add<&T::far>("far", "Farthest that is drawn, metres.", protocol::kPositive);
    f.add<&T::orbit>("orbit", "In place of eye: angles and a distance around the target.");
    f.add<&T::fit>("fit", "Keep the direction and bring all visible actors wholly into view.");
  }
  [[nodiscard]] Status check() const {
    if (eye && orbit) return fail(ErrorCode::InvalidParams, "expected eye or orbit, found both", "orbit");
    return {};
  }
};

struct CameraResult {
  static constexpr std::string_view kName = "CameraRevision";
  CameraState camera;
  std::uint64_t revision = 0;
  static void describe(FieldList<CameraResult>& f) {
    f.add<&CameraResult::camera>("camera", "As it is now.");
    f.add<&CameraResult::revision>("revision", "The scene's new revision.");
  }
};

struct LightParams : EditTarget {
  static constexpr std::string_view kName = "LightParams";
  std::optional<glm::vec3> position;
  std::optional<float> ambient, diffuse, specular, shininess;
  static void describe(FieldList<LightParams>& f) {
    using T = LightParams;
    add_edit_fields(f);
    f.add<&T::position>("position", "World space, metres.");
    f.add<&T::ambient>("ambient", "Intensity from everywhere.", protocol::kNotNegative);
    f.add<&T::diffuse>("diffuse", "Intensity of matt reflection.", protocol::kNotNegative);
    f.add<&T::specular>("specular", "Intensity of the highlight.", protocol::kNotNegative);
    f.add<&T::shininess>("shininess", "Exponent of the highlight.", protocol::kPositive);
  }
};

struct LightResult {
  static constexpr std::string_view kName = "LightRevision";
  LightState light;
  std::uint64_t revision = 0;
  static void describe(FieldList<LightResult>& f) {
    f.add<&LightResult::light>("light", "As it is now.");
    f.add<&LightResult::revision>("revision", "The scene's new revision.");
  }
};

Status check_camera(const model::Camera& c) {
  const glm::vec3 forward = c.target - c.eye;
  if (!(glm::length(forward) > 0.0F)) {
    return fail(ErrorCode::InvalidParams, "expected eye and target to be apart, found them at one place", "params.eye");
  }
  if (!(glm::length(glm::cross(glm::normalize(forward), c.up)) > 1e-6F)) {
    return fail(ErrorCode::InvalidParams, "expected up to point aside from the view, found it along it (or zero)", "params.up");
  }
  if (!(c.near < c.far)) return fail(ErrorCode::InvalidParams, "expected near to be less than far", "params.near");
  return {};
}

Result<CameraResult> set_camera(const CameraParams& p, EditContext& context) {
  model::SceneSettings settings = context.scene().settings;
  model::Camera& c = settings.camera;
  c.eye = p.eye.value_or(c.eye);
  c.target = p.target.value_or(c.target);
  c.up = p.up.value_or(c.up);
  c.fov_y = p.fov_y.value_or(c.fov_y);
  if (p.orbit) {
    c.target = p.orbit->target.value_or(c.target);
    c = model::orbit(c, p.orbit->azimuth, p.orbit->elevation, p.orbit->distance.value_or(glm::length(c.eye - c.target)));
  }
  if (p.fit.value_or(false)) {
    if (const auto sphere = model::bounding_sphere(context.scene())) c = model::fit(c, *sphere);
  }
  c.near = p.near.value_or(c.near);
  c.far = p.far.value_or(c.far);
  TWEEND_TRY(check_camera(c));
  context.transaction.apply(stage::SetSceneSettings{settings});
  return CameraResult{camera_state(c), 0};
}

Result<LightResult> set_light(const LightParams& p, EditContext& context) {
  model::SceneSettings settings = context.scene().settings;
  model::Light& l = settings.light;
  l = {p.position.value_or(l.position), p.ambient.value_or(l.ambient), p.diffuse.value_or(l.diffuse),
       p.specular.value_or(l.specular), p.shininess.value_or(l.shininess)};
  context.transaction.apply(stage::SetSceneSettings{settings});
  return LightResult{light_state(l), 0};
}

}  // namespace

void add_view_commands(std::vector<Command>& t) {
  t.push_back(edit_command<&set_camera>("camera.set", Role::Control, "Move the scene's camera."));
  t.push_back(edit_command<&set_light>("light.set", Role::Control, "Change the scene's light."));
}

}  // namespace tweend::commands
