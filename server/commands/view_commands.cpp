#include "server/commands/command_table.hpp"
#include "server/commands/view_types.hpp"

namespace tweend::commands {
namespace {

struct CameraParams : EditTarget, CameraFields, Timed {
  static constexpr std::string_view kName = "CameraParams";
  static void describe(FieldList<CameraParams>& f) {
    add_edit_fields(f);
    add_timed_fields(f);
    add_camera_fields(f);
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

Result<CameraResult> set_camera(const CameraParams& p, EditContext& context) {
  model::SceneSettings settings = context.scene().settings;
  const model::CameraRequest request = p.request();
  const auto visible = request.fit ? model::visible_bounds(context.scene()) : std::nullopt;
  auto placed = model::place(settings.camera, request, visible);
  if (!placed) return fail(placed.error().code, placed.error().message, "params." + placed.error().path);
  settings.camera = *placed;
  context.transaction.apply(stage::SetSceneSettings{settings});
  return CameraResult{camera_state(*placed), 0};
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

Status check_own_camera(const OwnCamera& camera, const model::Scene& scene) {
  const model::CameraRequest request = camera.request();
  // What is visible takes a look at every keyframe: only where it is asked for.
  const auto visible = request.fit ? model::visible_bounds(scene) : std::nullopt;
  const auto placed = model::place(scene.settings.camera, request, visible);
  if (placed) return {};
  return fail(placed.error().code, placed.error().message, "params.camera." + placed.error().path);
}

void add_view_commands(std::vector<Command>& t) {
  t.push_back(edit_command<&set_camera>("camera.set", Role::Control, "Move the scene's camera."));
  t.push_back(edit_command<&set_light>("light.set", Role::Control, "Change the scene's light."));
}

}  // namespace tweend::commands
