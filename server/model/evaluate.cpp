#include "server/model/evaluate.hpp"

#include <algorithm>
#include <array>

#include "server/animation/blend_poses.hpp"
#include "server/animation/blend_vertices.hpp"
#include "server/animation/local_to_model.hpp"
#include "server/animation/morph_vertices.hpp"
#include "server/animation/skin_vertices.hpp"

namespace tweend::model {
namespace {

bool is_skeletal(const Clip& clip) noexcept { return clip.type() == ClipType::Skeletal && !clip.keyframes.empty(); }
bool is_vertex(const Clip& clip) noexcept { return clip.type() == ClipType::Vertex && !clip.keyframes.empty(); }

animation::Interpolation fallback_of(const Actor& actor, const Clip& clip) noexcept {
  if (actor.settings.interpolation) return *actor.settings.interpolation;
  return clip.settings.interpolation.value_or(animation::Interpolation::Linear);
}

/// The rest pose with the weights that hold when nothing is keyed.
void reset_to_rest(const Model& model, animation::Pose& pose) {
  if (model.skeleton) {
    pose.assign(model.skeleton->rest(), model.weight_count());
  } else {
    pose.reset(0, model.weight_count());
  }
  if (model.morphs) {
    const std::span<const float> weights = model.morphs->default_weights();
    std::copy(weights.begin(), weights.end(), pose.weights().begin());
  }
}

void sample_clip(const Actor& actor, const Clip& clip, double time_s, animation::Pose& pose) {
  reset_to_rest(*actor.model, pose);
  if (is_skeletal(clip)) clip.tracks(*actor.model->skeleton).sample(time_s, fallback_of(actor, clip), pose);
}

void apply_live(const Skeleton& skeleton, const PoseKey& live, animation::Pose& pose) {
  for (const KeyedValue& v : live.values()) {
    const glm::vec4& value = v.value;
    if (v.channel.property == animation::Property::Weight) {
      pose.weights()[v.channel.target] = value.x;
      continue;
    }
    const std::uint32_t place = skeleton.place_of(v.channel.target);
    animation::JointPose joint = pose.joint(place);
    if (v.channel.property == animation::Property::Translation) joint.translation = glm::vec3(value);
    if (v.channel.property == animation::Property::Rotation) joint.rotation = glm::quat(value.w, value.x, value.y, value.z);
    if (v.channel.property == animation::Property::Scale) joint.scale = glm::vec3(value);
    pose.set_joint(place, joint);
  }
}

}  // namespace

Shown shown_clip(ClipPtr clip, double time_s) {
  Shown shown;
  shown.clips.push_back({std::move(clip), time_s, 1.0F});
  return shown;
}

bool shows_pose(const Shown& shown) noexcept {
  return std::none_of(shown.clips.begin(), shown.clips.end(), [](const ClipInstant& c) { return is_vertex(*c.clip); });
}

bool shows_vertices(const Shown& shown) noexcept {
  return std::all_of(shown.clips.begin(), shown.clips.end(), [](const ClipInstant& c) { return is_vertex(*c.clip); });
}

const animation::Pose& Evaluator::pose(const Actor& actor, const Shown& shown) {
  const Model& model = *actor.model;
  sample_clip(actor, *shown.clips.front().clip, shown.clips.front().time_s, pose_);
  for (std::size_t i = 1; i < shown.clips.size(); ++i) {
    const ClipInstant& next = shown.clips[i];
    sample_clip(actor, *next.clip, next.time_s, other_);
    animation::blend_poses(other_, next.weight, {}, pose_);
  }
  if (!shown.layers.empty()) reset_to_rest(model, rest_);
  for (const LayerInstant& layer : shown.layers) {
    if (!is_skeletal(*layer.clip)) continue;
    const std::span<const float> mask = layer.mask ? std::span<const float>(*layer.mask) : std::span<const float>();
    if (layer.additive) {
      sample_clip(actor, *layer.clip, layer.time_s, other_);
      animation::add_pose(other_, rest_, layer.weight, mask, pose_);
    } else {
      // A layer says nothing of joints that its clip does not key: there what is below it shows through.
      other_.assign(pose_, pose_.weights().size());
      std::copy(pose_.weights().begin(), pose_.weights().end(), other_.weights().begin());
      layer.clip->tracks(*model.skeleton).sample(layer.time_s, fallback_of(actor, *layer.clip), other_);
      animation::blend_poses(other_, layer.weight, mask, pose_);
    }
  }
  if (shown.live && model.skeleton) apply_live(*model.skeleton, *shown.live, pose_);
  return pose_;
}

std::span<const animation::Affine> Evaluator::model_from_joint(const Actor& actor, const Shown& shown) {
  static_cast<void>(pose(actor, shown));
  model_from_joint_.resize(actor.model->joint_count());
  if (const SkeletonPtr& skeleton = actor.model->skeleton) {
    animation::local_to_model(skeleton->parent_places(), pose_, model_from_joint_);
  }
  return model_from_joint_;
}

std::span<const animation::Affine> Evaluator::skin_matrices(const Actor& actor, const Shown& shown) {
  static_cast<void>(model_from_joint(actor, shown));
  skin_matrices_.clear();
  if (!actor.model->skin) return {};
  for (const SkinEntry& entry : actor.model->skin->entries()) {
    const std::uint32_t place = actor.model->skeleton->place_of(entry.joint);
    skin_matrices_.push_back(animation::multiply(model_from_joint_[place], entry.joint_from_mesh));
  }
  return skin_matrices_;
}

Status Evaluator::skinned(const Actor& actor, const Shown& shown, const animation::VertexTarget& out) {
  const Model& model = *actor.model;
  const std::span<const animation::Affine> matrices = skin_matrices(actor, shown);
  animation::VertexAttributes base = model.rest->attributes();
  const std::span<const float> weights = pose_.weights();
  const bool morphed = std::any_of(weights.begin(), weights.end(), [](float w) { return w != 0.0F; });
  if (morphed) {
    const std::span<const float> block = model.rest->block();
    morphed_.assign(block.begin(), block.end());
    const std::span<float> whole(morphed_);
    const std::size_t n = base.positions.size();
    const animation::VertexTarget target{whole.first(n), whole.subspan(n, n), whole.subspan(2 * n)};
    animation::morph_vertices(model.morphs->views(), weights, target);
    base = {target.positions, target.normals, target.tangents};
  }
  if (!model.skin) {
    const std::array sources{base};
    constexpr std::array kWhole{1.0F};
    return animation::blend_vertices(sources, kWhole, 0, out);
  }
  return animation::skin_vertices(model.skin->influences(), matrices, base, out);
}

Status Evaluator::faded(const Actor& actor, const Shown& shown, const animation::VertexTarget& out) {
  const auto one = [&](const ClipInstant& instant, const animation::VertexTarget& to) -> Status {
    if (is_vertex(*instant.clip)) return sample_keyframes(actor, *instant.clip, instant.time_s, to);
    Shown alone = shown;
    alone.clips.assign(1, instant);
    return skinned(actor, alone, to);
  };
  TWEEND_TRY(one(shown.clips.front(), out));
  const std::size_t sizes[] = {out.positions.size(), out.normals.size(), out.tangents.size()};
  faded_.resize(2 * (sizes[0] + sizes[1] + sizes[2]));
  const auto part = [&](std::size_t from) {
    const std::span<float> all = std::span(faded_).subspan(from);
    return animation::VertexTarget{all.first(sizes[0]), all.subspan(sizes[0], sizes[1]),
                                   all.subspan(sizes[0] + sizes[1], sizes[2])};
  };
  const animation::VertexTarget before = part(0), next = part(faded_.size() / 2);
  for (std::size_t i = 1; i < shown.clips.size(); ++i) {
    const float weight = shown.clips[i].weight;
    std::copy(out.positions.begin(), out.positions.end(), before.positions.begin());
    std::copy(out.normals.begin(), out.normals.end(), before.normals.begin());
    std::copy(out.tangents.begin(), out.tangents.end(), before.tangents.begin());
    TWEEND_TRY(one(shown.clips[i], next));
    const std::array sources{animation::VertexAttributes{before.positions, before.normals, before.tangents},
                             animation::VertexAttributes{next.positions, next.normals, next.tangents}};
    const std::array weights{1.0F - weight, weight};
    TWEEND_TRY(animation::blend_vertices(sources, weights, weight < 0.5F ? 0 : 1, out));
  }
  return {};
}

Status Evaluator::vertices(const Actor& actor, const Shown& shown, const animation::VertexTarget& out) {
  if (shown.clips.size() == 1 && is_vertex(*shown.clips.front().clip)) {
    return sample_keyframes(actor, *shown.clips.front().clip, shown.clips.front().time_s, out);
  }
  return shows_pose(shown) ? skinned(actor, shown, out) : faded(actor, shown, out);
}

}  // namespace tweend::model
