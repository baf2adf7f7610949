#include "server/animation/blend_poses.hpp"

#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

namespace tweend::animation {
namespace {

float joint_weight(float weight, std::span<const float> mask, std::size_t joint) {
  return mask.empty() ? weight : weight * mask[joint];
}

/// The short way from a to b, both unit.
glm::quat slerp_short(const glm::quat& a, const glm::quat& b, float u) {
  const glm::dquat from(a);
  glm::dquat to(b);
  if (glm::dot(from, to) < 0.0) to = -to;
  const double cosine = glm::dot(from, to);
  const double t = static_cast<double>(u);
  if (cosine > 1.0 - 1e-12) return glm::quat(glm::normalize(from * (1.0 - t) + to * t));
  const double angle = std::acos(cosine);
  return glm::quat((from * std::sin((1.0 - t) * angle) + to * std::sin(t * angle)) / std::sin(angle));
}

JointPose between(const JointPose& a, const JointPose& b, float u) {
  return {glm::mix(a.translation, b.translation, u), slerp_short(a.rotation, b.rotation, u), glm::mix(a.scale, b.scale, u)};
}

/// The part `weight` of the way from `rest` to `layer`, on top of `pose`.
JointPose added(const JointPose& pose, const JointPose& layer, const JointPose& rest, float weight) {
  const glm::quat turn = glm::conjugate(rest.rotation) * layer.rotation;
  JointPose sum = pose;
  sum.translation += weight * (layer.translation - rest.translation);
  sum.rotation = pose.rotation * slerp_short(glm::quat(1, 0, 0, 0), turn, weight);
  for (int i = 0; i < 3; ++i) {
    const float factor = rest.scale[i] == 0.0F ? 1.0F : layer.scale[i] / rest.scale[i];
    sum.scale[i] *= 1.0F + weight * (factor - 1.0F);
  }
  return sum;
}

}  // namespace

void blend_poses(const Pose& to, float weight, std::span<const float> mask, Pose& pose) noexcept {
  for (std::size_t j = 0; j < pose.joint_count(); ++j) {
    const float w = joint_weight(weight, mask, j);
    if (w == 0.0F) continue;
    pose.set_joint(j, w == 1.0F ? to.joint(j) : between(pose.joint(j), to.joint(j), w));
  }
  if (!mask.empty() || weight == 0.0F) return;
  for (std::size_t i = 0; i < pose.weights().size(); ++i) {
    float& value = pose.weights()[i];
    value = weight == 1.0F ? to.weights()[i] : glm::mix(value, to.weights()[i], weight);
  }
}

void add_pose(const Pose& layer, const Pose& rest, float weight, std::span<const float> mask, Pose& pose) noexcept {
  for (std::size_t j = 0; j < pose.joint_count(); ++j) {
    const float w = joint_weight(weight, mask, j);
    if (w != 0.0F) pose.set_joint(j, added(pose.joint(j), layer.joint(j), rest.joint(j), w));
  }
  if (!mask.empty() || weight == 0.0F) return;
  for (std::size_t i = 0; i < pose.weights().size(); ++i) {
    pose.weights()[i] += weight * (layer.weights()[i] - rest.weights()[i]);
  }
}

}  // namespace tweend::animation
