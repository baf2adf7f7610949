#include <fmt/format.h>

#include <memory>

#include "server/base/log.hpp"
#include "server/commands/command_table.hpp"
#include "server/commands/edit_helpers.hpp"
#include "server/commands/pose_types.hpp"

namespace tweend::commands {
namespace {

struct MeshParams {
  static constexpr std::string_view kName = "Mesh";
  std::vector<float> positions;
  std::optional<std::vector<float>> normals;
  std::vector<std::uint32_t> indices;
  static void describe(FieldList<MeshParams>& f) {
    using T = MeshParams;
    f.add<&T::positions>("positions", "x, y, z of each vertex, metres.");
    f.add<&T::normals>("normals", "x, y, z of each vertex; computed if left out.");
    f.add<&T::indices>("indices", "Three a triangle, counter-clockwise fronts.");
  }
};

struct ActorAddParams : EditTarget {
  static constexpr std::string_view kName = "ActorAddParams";
  protocol::Name actor;
  std::optional<std::string> asset;
  std::optional<MeshParams> mesh;
  std::optional<SkeletonParams> skeleton;
  std::optional<double> fps;
  std::optional<bool> closed;
  std::optional<double> duration;
  std::optional<TransformParams> transform;
  std::optional<Interpolation> interpolation;
  static void describe(FieldList<ActorAddParams>& f) {
    using T = ActorAddParams;
    add_edit_fields(f);
    f.add<&T::actor>("actor", "The new actor's name.");
    f.add<&T::asset>("asset", "An asset's name (asset.list has them); or give mesh or skeleton.");
    f.add<&T::mesh>("mesh", "A mesh; its clip `default` is empty at first.");
    f.add<&T::skeleton>("skeleton", "A skeleton; its clip `default` is empty at first.");
    f.add<&T::fps>("fps", "Frames a second of an OBJ sequence; 24 if left out.",
                   {.min = 0.0, .max = 10'000.0, .min_excluded = true});
    f.add<&T::closed>("closed", "Whether the clip blends from its last keyframe back to the first.");
    f.add<&T::duration>("duration", "Of the clip, seconds.", protocol::kPositive);
    f.add<&T::transform>("transform", "Where it stands.");
    f.add<&T::interpolation>("interpolation", "For all its clips, where a keyframe says no other.");
  }
  [[nodiscard]] Status check() const {
    const int given = int{asset.has_value()} + int{mesh.has_value()} + int{skeleton.has_value()};
    if (given != 1) {
      return fail(ErrorCode::InvalidParams,
                  fmt::format("expected one of asset, mesh and skeleton, found {}", given == 0 ? "none" : "several"),
                  given == 0 ? "asset"
                  : skeleton ? "skeleton"
                             : "mesh");
    }
    if (!asset && fps) {
      return fail(ErrorCode::InvalidParams,
                  fmt::format("expected fps with an OBJ sequence, found it with a {}", mesh ? "mesh" : "skeleton"), "fps");
    }
    return {};
  }
};

struct ActorAddResult {
  static constexpr std::string_view kName = "ActorAdded";
  std::string actor;
  std::vector<std::string> clips;
  std::uint64_t vertices = 0;
  std::uint64_t joints = 0;
  std::uint64_t revision = 0;
  static void describe(FieldList<ActorAddResult>& f) {
    using T = ActorAddResult;
    f.add<&T::actor>("actor", "Its name.");
    f.add<&T::clips>("clips", "Names of its clips.");
    f.add<&T::vertices>("vertices", "How many.");
    f.add<&T::joints>("joints", "How many.");
    f.add<&T::revision>("revision", "The scene's new revision.");
  }
};

struct ActorUpdateParams : EditTarget, Timed {
  static constexpr std::string_view kName = "ActorUpdateParams";
  std::optional<std::string> actor;
  std::optional<TransformParams> transform;
  Nullable<Interpolation> interpolation;
  std::optional<bool> visible;
  std::optional<bool> show_skeleton;
  std::optional<double> spin;
  static void describe(FieldList<ActorUpdateParams>& f) {
    using T = ActorUpdateParams;
    add_edit_fields(f);
    add_timed_fields(f);
    add_actor_field(f);
    f.add<&T::transform>("transform", "Where it stands; what is left out stays.");
    f.add<&T::interpolation>("interpolation", "For all its clips; null: let them say.");
    f.add<&T::visible>("visible", "Whether it is drawn.");
    f.add<&T::show_skeleton>("show_skeleton", "Whether joints and bones are drawn over the mesh.");
    f.add<&T::spin>("spin", "Radians a second about +Y while playing.");
  }
};

struct ActorRemoveParams : EditTarget {
  static constexpr std::string_view kName = "ActorRemoveParams";
  std::string actor;
  static void describe(FieldList<ActorRemoveParams>& f) {
    add_edit_fields(f);
    f.add<&ActorRemoveParams::actor>("actor", "Name of the actor.");
  }
};

/// Tells the scene's subscribers how far an import is: its beginning and its end, and what comes between now and then.
assets::ImportProgress tell_progress(const ActorAddParams& p, const Services& services) {
  constexpr ClockUs kEveryUs = 100'000;
  return [&p, &services, next_us = ClockUs{0}](double fraction) mutable {
    const ClockUs now_us = steady_now_us();
    if (now_us < next_us && fraction < 1.0) return;
    next_us = now_us + kEveryUs;
    services.events.importing(scene_or_main(p.scene), p.actor.text, *p.asset, fraction);
  };
}

/// A glTF file says itself when its clips end; its model is the one that has a skeleton.
Status check_clip_fields(const ActorAddParams& p, const model::ImportedModel& imported) {
  if (!imported.model->skeleton) return {};
  const char* const given = p.fps ? "fps" : p.closed ? "closed" : p.duration ? "duration" : nullptr;
  if (given == nullptr) return {};
  return fail(ErrorCode::InvalidParams,
              fmt::format("expected {} with an OBJ file or sequence only, found it with a glTF file", given),
              fmt::format("params.{}", given));
}

Result<model::ImportedModel> import_asset(const ActorAddParams& p, const Services& services) {
  auto imported = services.assets.import(*p.asset, {p.fps.value_or(24.0), tell_progress(p, services)});
  if (!imported) return fail(imported.error().code, imported.error().message, "params.asset");
  TWEEND_TRY(check_clip_fields(p, *imported));
  for (const std::string& warning : imported->warnings) log::warn(warning);
  return imported;
}

Result<model::ImportedModel> make_mesh(const MeshParams& p, const Services& services) {
  const std::size_t vertices = p.positions.size() / 3;
  if (p.positions.size() % 3 != 0) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected three numbers a vertex, found {} numbers", p.positions.size()),
                "params.mesh.positions");
  }
  if (vertices > services.limits.vertices_per_actor) {
    return fail(ErrorCode::Limit,
                fmt::format("expected at most {} vertices, found {}", services.limits.vertices_per_actor, vertices),
                "params.mesh.positions");
  }
  auto mesh = model::Mesh::make(vertices, p.indices);
  if (!mesh)
    return fail(mesh.error().code, mesh.error().message, vertices == 0 ? "params.mesh.positions" : "params.mesh.indices");
  auto rest =
      model::VertexKey::make(**mesh, p.positions, p.normals ? std::span<const float>(*p.normals) : std::span<const float>());
  if (!rest) return fail(rest.error().code, rest.error().message, "params.mesh." + rest.error().path);
  auto model = std::make_shared<const model::Model>(model::Model{*mesh, *rest, {}, {}, {}});
  return model::ImportedModel{"mesh", std::move(model), model::empty_clips(), {}};
}

Result<model::ImportedModel> make_bare_skeleton(const SkeletonParams& p, const Services& services) {
  TWEEND_ASSIGN(model::SkeletonPtr skeleton, make_skeleton(p, services.limits));
  auto model = std::make_shared<const model::Model>(model::Model{{}, {}, std::move(skeleton), {}, {}});
  return model::ImportedModel{"skeleton", std::move(model), model::empty_clips(), {}};
}

Result<model::ImportedModel> make_source(const ActorAddParams& p, const Services& services) {
  if (p.asset) return import_asset(p, services);
  return p.mesh ? make_mesh(*p.mesh, services) : make_bare_skeleton(*p.skeleton, services);
}

/// The actor's clips, with ids for their keyframes and what the request says of them.
Result<std::vector<model::ClipPtr>> make_clips(const ActorAddParams& p, const model::ImportedModel& source,
                                               EditContext& context) {
  std::vector<model::ClipPtr> clips;
  for (const model::Clip& from : source.clips) {
    const std::size_t most = context.services.limits.keyframes_per_clip;
    if (from.keyframes.size() > most) {
      return fail(
          ErrorCode::Limit,
          fmt::format("expected at most {} keyframes in a clip, found {} in \"{}\"", most, from.keyframes.size(), from.name),
          "params.asset");
    }
    model::Clip clip = from;
    clip.settings.closed = p.closed.value_or(clip.settings.closed);
    if (p.duration) clip.settings.duration_s = p.duration;
    for (model::Keyframe& keyframe : clip.keyframes) keyframe.id = context.transaction.new_keyframe_id();
    TWEEND_TRY(check_duration(clip));
    clips.push_back(std::make_shared<const model::Clip>(std::move(clip)));
  }
  return clips;
}

Result<ActorAddResult> add_actor(const ActorAddParams& p, EditContext& context) {
  // Cheap refusals first: a file is not read for a name that is taken.
  if (context.scene().find_actor(p.actor.text)) {
    return fail(ErrorCode::Conflict, fmt::format("expected a new name, found the actor \"{}\"", p.actor.text), "params.actor");
  }
  if (const std::size_t most = context.services.limits.actors_per_scene; context.scene().actors.size() >= most) {
    return fail(ErrorCode::Limit, fmt::format("expected at most {} actors in a scene, found as many; remove one first", most));
  }
  const Result<model::ImportedModel>& source = context.once("source", [&] { return make_source(p, context.services); });
  if (!source) return source.error();
  model::Actor actor;
  actor.name = p.actor.text;
  actor.source = source->source;
  actor.model = source->model;
  actor.settings.interpolation = p.interpolation;
  if (p.transform) p.transform->apply_to(actor.settings.transform);
  TWEEND_ASSIGN(actor.clips, make_clips(p, *source, context));

  ActorAddResult result{actor.name, {}, actor.model->vertex_count(), actor.model->joint_count(), 0};
  for (const model::ClipPtr& clip : actor.clips) result.clips.push_back(clip->name);
  context.transaction.apply(stage::SetActor{actor.name, std::make_shared<const model::Actor>(std::move(actor))});
  context.transaction.about({result.actor, {}, {}});
  return result;
}

Result<RevisionResult> update_actor(const ActorUpdateParams& p, EditContext& context) {
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(context.scene(), p.actor));
  model::ActorSettings settings = actor->settings;
  if (p.transform) p.transform->apply_to(settings.transform);
  settings.interpolation = p.interpolation.value_or(settings.interpolation);
  settings.visible = p.visible.value_or(settings.visible);
  settings.show_skeleton = p.show_skeleton.value_or(settings.show_skeleton);
  settings.spin_rad_s = p.spin.value_or(settings.spin_rad_s);
  context.transaction.apply(stage::SetActorSettings{actor->name, settings});
  context.transaction.about({actor->name, {}, {}});
  return RevisionResult{};
}

Result<RevisionResult> remove_actor(const ActorRemoveParams& p, EditContext& context) {
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(context.scene(), p.actor));
  context.transaction.apply(stage::SetActor{actor->name, nullptr});
  context.transaction.about({actor->name, {}, {}});
  return RevisionResult{};
}

}  // namespace

void add_actor_commands(std::vector<Command>& t) {
  t.push_back(edit_command<&add_actor>("actor.add", Role::Control, "Add a model, from an asset, a mesh or a skeleton.",
                                       Shape::HeavyEdit));
  t.push_back(edit_command<&update_actor>("actor.update", Role::Control, "Move an actor, or change how it is shown."));
  t.push_back(edit_command<&remove_actor>("actor.remove", Role::Control, "Remove an actor."));
}

}  // namespace tweend::commands
