#include "server/commands/pose_types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tweend::commands {

using animation::Channel;
using animation::Property;

void JointParams::describe(FieldList<JointParams>& f) {
  using T = JointParams;
  f.add<&T::translation>("translation", "Relative to the parent, metres.");
  f.add<&T::translation_in_tangent>("translation_in_tangent", "For cubic: metres a second, as it arrives.");
  f.add<&T::translation_out_tangent>("translation_out_tangent", "For cubic: metres a second, as it leaves.");
  f.add<&T::rotation>("rotation", "Quaternion [x, y, z, w]; normalised.");
  f.add<&T::rotation_in_tangent>("rotation_in_tangent", "For cubic: of [x, y, z, w] a second, as it arrives.");
  f.add<&T::rotation_out_tangent>("rotation_out_tangent", "For cubic: of [x, y, z, w] a second, as it leaves.");
  f.add<&T::scale>("scale", "Factors along x, y and z.");
  f.add<&T::scale_in_tangent>("scale_in_tangent", "For cubic: a second, as it arrives.");
  f.add<&T::scale_out_tangent>("scale_out_tangent", "For cubic: a second, as it leaves.");
}

namespace {

Status beside_value(bool value, bool in, bool out, std::string_view name) {
  if (value || (!in && !out)) return {};
  return fail(ErrorCode::InvalidParams, fmt::format("expected {} beside its tangents, found none", name),
              fmt::format("{}_{}_tangent", name, in ? "in" : "out"));
}

}  // namespace

Status JointParams::check() const {
  TWEEND_TRY(beside_value(translation.has_value(), translation_in_tangent.has_value(), translation_out_tangent.has_value(),
                          "translation"));
  TWEEND_TRY(beside_value(rotation.has_value(), rotation_in_tangent.has_value(), rotation_out_tangent.has_value(), "rotation"));
  return beside_value(scale.has_value(), scale_in_tangent.has_value(), scale_out_tangent.has_value(), "scale");
}

void SkeletonJointParams::describe(FieldList<SkeletonJointParams>& f) {
  using T = SkeletonJointParams;
  f.add<&T::name>("name", "Used once in its skeleton.");
  f.add<&T::parent>("parent", "Name of another joint, before or after this one; a root if left out.");
  f.add<&T::translation>("translation", "At rest, relative to the parent, metres.");
  f.add<&T::rotation>("rotation", "At rest: quaternion [x, y, z, w]; normalised.");
  f.add<&T::scale>("scale", "At rest: factors along x, y and z.");
}

void SkeletonParams::describe(FieldList<SkeletonParams>& f) {
  f.add<&SkeletonParams::joints>("joints", "In any order, which they keep.");
}

Result<model::SkeletonPtr> make_skeleton(const SkeletonParams& p, const Limits& limits) {
  if (p.joints.size() > limits.joints_per_actor) {
    return fail(ErrorCode::Limit, fmt::format("expected at most {} joints, found {}", limits.joints_per_actor, p.joints.size()),
                "params.skeleton.joints");
  }
  std::vector<model::Joint> joints;
  std::unordered_map<std::string_view, std::int32_t> index;
  for (const SkeletonJointParams& j : p.joints) index.emplace(j.name, static_cast<std::int32_t>(index.size()));
  // Names that come twice leave the indices wrong, and the skeleton refuses them before it looks at a parent.
  for (std::size_t i = 0; i < p.joints.size(); ++i) {
    const SkeletonJointParams& j = p.joints[i];
    model::Joint& joint = joints.emplace_back();
    joint.name = j.name;
    joint.rest = {j.translation.value_or(joint.rest.translation), j.rotation.value_or(joint.rest.rotation),
                  j.scale.value_or(joint.rest.scale)};
    if (!j.parent) continue;
    const auto at = index.find(*j.parent);
    if (at == index.end()) {
      return fail(ErrorCode::InvalidParams,
                  fmt::format("expected the name of a joint of this skeleton, found \"{}\"", *j.parent),
                  fmt::format("params.skeleton.joints[{}].parent", i));
    }
    joint.parent = at->second;
  }
  auto skeleton = model::Skeleton::make(std::move(joints));
  if (!skeleton) return fail(skeleton.error().code, skeleton.error().message, "params.skeleton." + skeleton.error().path);
  return skeleton;
}

void KeyedPose::set(const Channel& channel, const glm::vec4& value, const model::KeyedTangents& with) {
  has_tangents = has_tangents || with != model::KeyedTangents{};
  const auto at = std::lower_bound(values.begin(), values.end(), channel,
                                   [](const model::KeyedValue& v, const Channel& c) { return v.channel < c; });
  const auto tangents_at = tangents.begin() + (at - values.begin());
  if (at != values.end() && at->channel == channel) {
    at->value = value;
    *tangents_at = with;
    return;
  }
  tangents.insert(tangents_at, with);
  values.insert(at, {channel, value});
}

model::PoseKeyPtr KeyedPose::key() && {
  if (!has_tangents) tangents.clear();
  return std::make_shared<const model::PoseKey>(std::move(values), std::move(tangents));
}

namespace {

glm::vec4 xyzw(const glm::quat& q) noexcept { return {q.x, q.y, q.z, q.w}; }

glm::vec4 xyzw(const std::optional<std::array<double, 4>>& v) noexcept {
  if (!v) return glm::vec4(0.0F);
  return {static_cast<float>((*v)[0]), static_cast<float>((*v)[1]), static_cast<float>((*v)[2]), static_cast<float>((*v)[3])};
}

glm::vec4 xyz0(const std::optional<glm::vec3>& v) noexcept { return {v.value_or(glm::vec3(0.0F)), 0.0F}; }

}  // namespace

void add_whole_pose(const model::Model& model, const animation::Pose& pose, KeyedPose& out) {
  for (std::uint32_t joint = 0; joint < model.joint_count(); ++joint) {
    const animation::JointPose at = pose.joint(model.skeleton->place_of(joint));
    out.set({joint, Property::Translation}, {at.translation, 0.0F});
    out.set({joint, Property::Rotation}, xyzw(at.rotation));
    out.set({joint, Property::Scale}, {at.scale, 0.0F});
  }
  for (std::uint32_t i = 0; i < model.weight_count(); ++i) {
    out.set({i, Property::Weight}, {pose.weights()[i], 0.0F, 0.0F, 0.0F});
  }
}

Status add_given_pose(const model::Actor& actor, const PoseParams& given, KeyedPose& out) {
  if (!actor.model->skeleton) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected an actor with a skeleton, found that \"{}\" has none", actor.name), "params.pose");
  }
  for (const auto& [name, j] : given.list) {
    const auto joint = actor.model->skeleton->find(name);
    if (!joint) {
      return fail(ErrorCode::InvalidParams,
                  fmt::format("expected names of joints of the actor \"{}\", found \"{}\"; scene.describe tells them",
                              actor.name, name),
                  "params.pose." + name);
    }
    if (j.translation) {
      out.set({*joint, Property::Translation}, xyz0(j.translation),
              {xyz0(j.translation_in_tangent), xyz0(j.translation_out_tangent)});
    }
    if (j.rotation) {
      out.set({*joint, Property::Rotation}, xyzw(*j.rotation), {xyzw(j.rotation_in_tangent), xyzw(j.rotation_out_tangent)});
    }
    if (j.scale) {
      out.set({*joint, Property::Scale}, xyz0(j.scale), {xyz0(j.scale_in_tangent), xyz0(j.scale_out_tangent)});
    }
  }
  return {};
}

}  // namespace tweend::commands
