#include "server/streams/frame_composer.hpp"

#include <cstdint>
#include <span>

#include "server/streams/bone_sources.hpp"
#include "server/streams/mesh_source.hpp"

namespace tweend::streams {
namespace {

render::KeySource key_source(const model::VertexKey& key) noexcept { return {resource_id(key.hash()), key.block()}; }

/// Adds `share` of what a clip's keyframes make to the item.
/// @return whether its four places were enough
bool add_keyframes(const model::Actor& actor, const model::ClipInstant& instant, float share, render::DrawItem& item) {
  const animation::KeyBlend blend = model::blend_at(actor, *instant.clip, instant.time_s);
  for (std::uint32_t i = 0; i < blend.count; ++i) {
    const render::KeySource key = key_source(*instant.clip->keyframes[blend.key[i]].vertices);
    std::uint32_t at = 0;
    while (at < item.key_count && item.key[at].id != key.id) ++at;
    if (at == item.key.size()) return false;
    if (at == item.key_count) item.key[item.key_count++] = key;
    item.weight[at] += share * blend.weight[i];
    if (i == blend.nearest && share >= 0.5F) item.nearest = at;
  }
  return true;
}

/// The clips of vertices that fade into each other, as one blend: they are sums of keyframes, and so is what they make
/// together. Of normals the sum is scaled to unit length once and not after each clip, which no eye can tell.
/// @return whether their keyframes are few enough
bool set_keyframes(const stage::ActorShow& show, render::DrawItem& item) {
  item.key_count = 0;
  item.weight = {};
  item.keys_expected = 0;
  float left = 1.0F;  // what the clips after this one leave of it
  const auto& clips = show.shown.clips;
  for (std::size_t i = clips.size(); i-- > 0;) {
    const float share = i == 0 ? left : left * clips[i].weight;
    left -= share;
    item.keys_expected += clips[i].clip->keyframes.size();
    if (share != 0.0F && !add_keyframes(*show.actor, clips[i], share, item)) return false;
  }
  return true;
}

}  // namespace

void FrameComposer::compose(const stage::Show& show, const std::optional<model::CameraRequest>& camera, render::Size size,
                            render::Picture& out) {
  compose(show, out);
  look_.look(show.scene, camera, size, out);
}

void FrameComposer::compose(const stage::Show& show, render::Picture& out) {
  const model::SceneSettings& settings = show.scene->settings;
  const model::Light& light = settings.light;
  out.light = {light.position, light.ambient, light.diffuse, light.specular, light.shininess};
  out.background = settings.background;
  out.grid = settings.grid;
  out.items.clear();
  out.bones.clear();
  out.bones_over.clear();
  slots_.resize(show.actors.size());
  for (std::size_t i = 0; i < show.actors.size(); ++i) {
    if (show.actors[i].actor->settings.visible) add_actor(show.actors[i], slots_[i], out);
  }
}

void FrameComposer::add_actor(const stage::ActorShow& show, Slot& slot, render::Picture& out) {
  const model::Actor& actor = *show.actor;
  const model::Model& model = *actor.model;
  if (slot.model != actor.model) {
    slot.model = actor.model;
    slot.source = model.mesh ? mesh_source(actor.model) : nullptr;
  }
  const glm::mat4 world_from_model = model::world_from_model(actor.settings.transform, show.spin_angle_rad);
  const bool posed = model::shows_pose(show.shown);
  if (slot.source) {
    render::DrawItem& item = out.items.emplace_back();
    item.mesh = slot.source;
    item.world_from_model = world_from_model;
    if (posed) {
      set_pose(show, slot, item);
    } else if (!model::shows_vertices(show.shown) || !set_keyframes(show, item)) {
      set_vertices(show, slot, item);
    }
  }
  if (!model.skeleton || (slot.source && !actor.settings.show_skeleton)) return;
  const bool known = slot.source && posed;
  const auto joints = known ? slot.evaluator.last_joints() : slot.evaluator.model_from_joint(actor, show.shown);
  add_bones(*model.skeleton, joints, world_from_model, slot.source ? out.bones_over : out.bones);
}

void FrameComposer::set_pose(const stage::ActorShow& show, Slot& slot, render::DrawItem& item) {
  const model::Actor& actor = *show.actor;
  item.key[0] = key_source(*actor.model->rest);
  if (!actor.model->skeleton && !actor.model->morphs) return;
  const std::span<const animation::Affine> palette = slot.evaluator.skin_matrices(actor, show.shown);
  static_assert(sizeof(animation::Affine) == 12 * sizeof(float));
  if (!palette.empty()) item.palette = {&palette.front().rows[0].x, 12 * palette.size()};
  item.morph_weights = slot.evaluator.last_weights();
}

void FrameComposer::set_vertices(const stage::ActorShow& show, Slot& slot, render::DrawItem& item) {
  const model::Model& model = *show.actor->model;
  slot.vertices.resize(model.rest->block().size());
  const std::span<float> all(slot.vertices);
  const std::size_t stream = 3 * model.vertex_count();
  // The lengths are right by construction: there is nothing to fail.
  static_cast<void>(slot.evaluator.vertices(*show.actor, show.shown,
                                            {all.first(stream), all.subspan(stream, stream), all.subspan(2 * stream)}));
  item.vertices = all;
}

}  // namespace tweend::streams
