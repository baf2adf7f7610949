#include <fmt/format.h>

#include "server/commands/command_table.hpp"
#include "server/commands/view_types.hpp"

namespace tweend::commands {
namespace {

struct SceneListParams {
  static constexpr std::string_view kName = "SceneListParams";
  static void describe(FieldList<SceneListParams>&) {}
};

struct SceneEntry {
  static constexpr std::string_view kName = "SceneEntry";
  std::string scene;
  std::uint64_t revision = 0;
  std::uint64_t actors = 0;
  static void describe(FieldList<SceneEntry>& f) {
    f.add<&SceneEntry::scene>("scene", "Its name.");
    f.add<&SceneEntry::revision>("revision", "Raised by one by each edit.");
    f.add<&SceneEntry::actors>("actors", "How many it has.");
  }
};

struct SceneListResult {
  static constexpr std::string_view kName = "SceneList";
  std::vector<SceneEntry> scenes;
  static void describe(FieldList<SceneListResult>& f) { f.add<&SceneListResult::scenes>("scenes", "Sorted by name."); }
};

struct NewSceneParams : EditTarget {
  static constexpr std::string_view kName = "NewSceneParams";
  protocol::Name name;
  static void describe(FieldList<NewSceneParams>& f) {
    using T = NewSceneParams;
    f.add<&T::name>("scene", "The new scene's name.");
    f.add<&T::base_revision>("base_revision", "Of no use here: a new scene has no revision before this.");
    f.add<&T::retry_key>("retry_key", "The client's choice, 1 to 64 characters: a repetition is answered as the first was.");
  }
};

struct OldSceneParams : EditTarget {
  static constexpr std::string_view kName = "OldSceneParams";
  std::string name;
  static void describe(FieldList<OldSceneParams>& f) {
    using T = OldSceneParams;
    f.add<&T::name>("scene", "The scene to remove; main stays.");
    f.add<&T::base_revision>("base_revision", "Refuse if the scene has gone past this revision.");
    f.add<&T::retry_key>("retry_key", "The client's choice, 1 to 64 characters: a repetition is answered as the first was.");
  }
};

struct SceneResult {
  static constexpr std::string_view kName = "SceneRevision";
  std::string scene;
  std::uint64_t revision = 0;
  static void describe(FieldList<SceneResult>& f) {
    f.add<&SceneResult::scene>("scene", "Its name.");
    f.add<&SceneResult::revision>("revision", "The scene's revision.");
  }
};

struct SceneUpdateParams : EditTarget {
  static constexpr std::string_view kName = "SceneUpdateParams";
  std::optional<glm::vec3> background;
  std::optional<bool> grid;
  static void describe(FieldList<SceneUpdateParams>& f) {
    using T = SceneUpdateParams;
    add_edit_fields(f);
    f.add<&T::background>("background", "sRGB [r, g, b], each 0 to 1.", {.min = 0.0, .max = 1.0});
    f.add<&T::grid>("grid", "Whether a ground grid is drawn.");
  }
};

struct SceneDescribeParams {
  static constexpr std::string_view kName = "SceneDescribeParams";
  std::optional<std::string> scene;
  static void describe(FieldList<SceneDescribeParams>& f) { add_scene_field(f); }
};

struct TransformState {
  static constexpr std::string_view kName = "TransformState";
  glm::vec3 translation{};
  glm::quat rotation{};
  glm::vec3 scale{};
  static void describe(FieldList<TransformState>& f) {
    using T = TransformState;
    f.add<&T::translation>("translation", "Metres.");
    f.add<&T::rotation>("rotation", "Quaternion [x, y, z, w].");
    f.add<&T::scale>("scale", "Factors along x, y and z.");
  }
};

struct ClipState {
  static constexpr std::string_view kName = "Clip";
  std::string clip;
  Nullable<WireClipType> type;
  std::uint64_t keyframes = 0;
  double duration = 0.0;
  bool closed = false;
  Nullable<Interpolation> interpolation;
  static void describe(FieldList<ClipState>& f) {
    using T = ClipState;
    f.add<&T::clip>("clip", "Its name.");
    f.add<&T::type>("type", "What its keyframes hold; null until the first one says.");
    f.add<&T::keyframes>("keyframes", "How many.");
    f.add<&T::duration>("duration", "Seconds.");
    f.add<&T::closed>("closed", "Whether it blends from its last keyframe back to the first.");
    f.add<&T::interpolation>("interpolation", "Where neither keyframe nor actor say; null: linear.");
  }
};

struct LayerState {
  static constexpr std::string_view kName = "Layer";
  std::string layer;
  std::string clip;
  float weight = 1.0F;
  bool additive = false;
  std::optional<std::vector<std::string>> mask;
  static void describe(FieldList<LayerState>& f) {
    using T = LayerState;
    f.add<&T::layer>("layer", "Its name.");
    f.add<&T::clip>("clip", "What it plays.");
    f.add<&T::weight>("weight", "0 to 1; while it fades, where it is going.");
    f.add<&T::additive>("additive", "Whether it adds rather than replaces.");
    f.add<&T::mask>("mask", "The joints it touches; left out: all.");
  }
};

struct ActorState {
  static constexpr std::string_view kName = "Actor";
  std::string actor;
  std::string source;
  TransformState transform;
  Nullable<Interpolation> interpolation;
  bool visible = true;
  bool show_skeleton = false;
  double spin = 0.0;
  PlayerState player;
  std::vector<ClipState> clips;
  std::vector<LayerState> layers;
  std::vector<JointState> joints;
  std::vector<std::string> weights;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  static void describe(FieldList<ActorState>& f) {
    using T = ActorState;
    f.add<&T::actor>("actor", "Its name.");
    f.add<&T::source>("source", "The asset it came from, or mesh, or skeleton.");
    f.add<&T::transform>("transform", "World from model.");
    f.add<&T::interpolation>("interpolation", "The actor's own; null: its clips say.");
    f.add<&T::visible>("visible", "Whether it is drawn.");
    f.add<&T::show_skeleton>("show_skeleton", "Whether joints and bones are drawn over the mesh.");
    f.add<&T::spin>("spin", "Radians a second about +Y while playing.");
    f.add<&T::player>("player", "Its transport.");
    f.add<&T::clips>("clips", "In the order they were made.");
    f.add<&T::layers>("layers", "In the order they lie over each other.");
    f.add<&T::joints>("joints", "Its skeleton; a mesh without one has none.");
    f.add<&T::weights>("weights", "Names of its morph targets.");
    f.add<&T::vertices>("vertices", "How many.");
    f.add<&T::triangles>("triangles", "How many.");
  }
};

struct SceneDescription {
  static constexpr std::string_view kName = "Scene";
  std::string scene;
  std::uint64_t revision = 0;
  std::vector<ActorState> actors;
  CameraState camera;
  LightState light;
  glm::vec3 background{};
  bool grid = false;
  static void describe(FieldList<SceneDescription>& f) {
    using T = SceneDescription;
    f.add<&T::scene>("scene", "Its name.");
    f.add<&T::revision>("revision", "Raised by one by each edit.");
    f.add<&T::actors>("actors", "In the order they were added.");
    f.add<&T::camera>("camera", "The scene's own camera.");
    f.add<&T::light>("light", "The point light.");
    f.add<&T::background>("background", "sRGB, each 0 to 1.");
    f.add<&T::grid>("grid", "Whether a ground grid is drawn.");
  }
};

ClipState clip_state(const model::Clip& clip) {
  ClipState state{clip.name,         std::optional<WireClipType>(), clip.keyframes.size(),
                  clip.duration_s(), clip.settings.closed,          clip.settings.interpolation};
  if (clip.type() == model::ClipType::Vertex) state.type = WireClipType::Vertex;
  if (clip.type() == model::ClipType::Skeletal) state.type = WireClipType::Skeletal;
  return state;
}

LayerState layer_state(const model::Actor& actor, const model::Layer& layer) {
  LayerState state{layer.name, layer.clip, layer.weight, layer.additive, {}};
  if (!layer.joints) return state;
  state.mask.emplace();
  for (const std::uint32_t joint : *layer.joints) state.mask->push_back(actor.model->skeleton->joints()[joint].name);
  return state;
}

ActorState actor_state(const stage::SceneView& view, std::size_t index, ClockUs now_us) {
  const model::Actor& actor = *view.scene->actors[index];
  const model::ActorSettings& s = actor.settings;
  ActorState state{actor.name,
                   actor.source,
                   {s.transform.translation, s.transform.rotation, s.transform.scale},
                   s.interpolation,
                   s.visible,
                   s.show_skeleton,
                   s.spin_rad_s,
                   player_state(view, index, now_us),
                   {},
                   {},
                   joint_states(*actor.model),
                   weight_names(*actor.model),
                   actor.model->vertex_count(),
                   actor.model->mesh ? actor.model->mesh->triangle_count() : 0};
  for (const model::ClipPtr& clip : actor.clips) state.clips.push_back(clip_state(*clip));
  for (const model::Layer& layer : actor.layers) state.layers.push_back(layer_state(actor, layer));
  return state;
}

Result<SceneListResult> list_scenes(const SceneListParams&, const QueryContext& context) {
  SceneListResult result;
  for (const auto& [name, view] : context.view->scenes) {
    result.scenes.push_back({name, view->scene->revision, view->scene->actors.size()});
  }
  return result;
}

Result<SceneDescription> describe_scene(const SceneDescribeParams& p, const QueryContext& context) {
  const stage::SceneViewPtr view = context.view->find(scene_or_main(p.scene));
  if (!view) return no_such_scene(scene_or_main(p.scene));
  const model::SceneSettings& s = view->scene->settings;
  SceneDescription d{view->scene->name,    view->scene->revision, {},    camera_state(s.camera),
                     light_state(s.light), s.background,          s.grid};
  for (std::size_t i = 0; i < view->scene->actors.size(); ++i) d.actors.push_back(actor_state(*view, i, context.now_us));
  return d;
}

Result<RevisionResult> update_scene(const SceneUpdateParams& p, EditContext& context) {
  model::SceneSettings settings = context.scene().settings;
  settings.background = p.background.value_or(settings.background);
  settings.grid = p.grid.value_or(settings.grid);
  context.transaction.apply(stage::SetSceneSettings{settings});
  return RevisionResult{};
}

void create_scene(const NewSceneParams& p, const Services& services, stage::EditOptions options, stage::EditDone done) {
  options.scene = p.name.text;
  if (options.base_revision) {
    return done(fail(ErrorCode::InvalidParams, "expected no base_revision: the scene is new", "params.base_revision"));
  }
  const auto answer = [name = p.name.text](std::uint64_t revision) { return protocol::encode(SceneResult{name, revision}); };
  services.stage.create_scene(std::move(options), answer, std::move(done));
}

void remove_scene(const OldSceneParams& p, const Services& services, stage::EditOptions options, stage::EditDone done) {
  if (p.name == "main") {
    return done(fail(ErrorCode::InvalidParams, "expected another scene than main: it always exists", "params.scene"));
  }
  options.scene = p.name;
  const auto answer = [name = p.name](std::uint64_t revision) { return protocol::encode(SceneResult{name, revision}); };
  services.stage.remove_scene(std::move(options), answer, std::move(done));
}

}  // namespace

void add_scene_commands(std::vector<Command>& t) {
  t.push_back(query_command<&list_scenes>("scene.list", Role::View, "All scenes."));
  t.push_back(scene_command<SceneResult, NewSceneParams, &create_scene>("scene.create", Role::Admin, "Make an empty scene."));
  t.push_back(scene_command<SceneResult, OldSceneParams, &remove_scene>("scene.remove", Role::Admin,
                                                                        "Remove a scene and all in it; it can't be undone."));
  t.push_back(edit_command<&update_scene>("scene.update", Role::Control, "Change the background or the grid."));
  t.push_back(
      query_command<&describe_scene>("scene.describe", Role::View, "All of a scene but its keyframes.", Shape::WorkerQuery));
}

}  // namespace tweend::commands
