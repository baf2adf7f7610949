#include "server/streams/bone_sources.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace tweend::streams {
namespace {

/// A ball's radius, of the longest bone that ends at its joint.
constexpr float kBallOfBone = 0.05F;
/// The same where there are no bones, of the distance that the picture looks at.
constexpr float kBallOfFocus = 0.02F;

glm::vec3 place_of(const animation::Affine& m, const glm::mat4& world_from_model) noexcept {
  return glm::vec3(world_from_model * glm::vec4(m.rows[0].w, m.rows[1].w, m.rows[2].w, 1.0F));
}

glm::vec3 axis_of(const animation::Affine& m, int axis, const glm::mat4& world_from_model) noexcept {
  return glm::mat3(world_from_model) * glm::vec3(m.rows[0][axis], m.rows[1][axis], m.rows[2][axis]);
}

/// What is left of `axis` across `along`, of unit length; zero where nothing is.
glm::vec3 across(const glm::vec3& axis, const glm::vec3& along) noexcept {
  const glm::vec3 rest = axis - glm::dot(axis, along) * along;
  const float length = glm::length(rest);
  return length > 0.3F * glm::length(axis) && length > 0.0F ? rest / length : glm::vec3(0.0F);
}

/// A direction across the bone that turns with its parent joint, so that the bone is seen to turn.
glm::vec3 side_of(const animation::Affine& parent, const glm::mat4& world_from_model, const glm::vec3& along) noexcept {
  for (const int axis : {0, 2, 1}) {
    const glm::vec3 side = across(axis_of(parent, axis, world_from_model), along);
    if (side != glm::vec3(0.0F)) return side;
  }
  // The joint is scaled away: any direction will do.
  return across(std::abs(along.x) < 0.5F ? glm::vec3(1.0F, 0.0F, 0.0F) : glm::vec3(0.0F, 0.0F, 1.0F), along);
}

}  // namespace

void add_bones(const model::Skeleton& skeleton, std::span<const animation::Affine> model_from_joint,
               const glm::mat4& world_from_model, std::vector<render::BoneSource>& out) {
  const std::size_t first = out.size();
  const std::span<const std::int32_t> parents = skeleton.parent_places();
  float length_of_all_m = 0.0F;
  std::size_t bones = 0;
  for (std::size_t place = 0; place < model_from_joint.size(); ++place) {
    render::BoneSource& bone = out.emplace_back();
    bone.joint = bone.parent = place_of(model_from_joint[place], world_from_model);
    if (parents[place] < 0) continue;
    const auto parent_place = static_cast<std::size_t>(parents[place]);
    render::BoneSource& parent = out[first + parent_place];
    bone.parent = parent.joint;
    const float length_m = glm::distance(bone.joint, bone.parent);
    if (!(length_m > 0.0F)) continue;
    bone.side = side_of(model_from_joint[parent_place], world_from_model, (bone.joint - bone.parent) / length_m);
    // Until all bones are known, a ball's radius is the length of the longest that ends there.
    bone.radius = std::max(bone.radius, length_m);
    parent.radius = std::max(parent.radius, length_m);
    length_of_all_m += length_m;
    ++bones;
  }
  const float lone_m = bones > 0 ? kBallOfBone * length_of_all_m / static_cast<float>(bones) : 0.0F;
  for (std::size_t i = first; i < out.size(); ++i) out[i].radius = out[i].radius > 0.0F ? kBallOfBone * out[i].radius : lone_m;
}

void size_lone_balls(float focus_m, std::vector<render::BoneSource>& bones) {
  for (render::BoneSource& bone : bones) {
    if (!(bone.radius > 0.0F)) bone.radius = kBallOfFocus * focus_m;
  }
}

}  // namespace tweend::streams
