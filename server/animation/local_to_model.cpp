#include "server/animation/local_to_model.hpp"

#include <cstddef>
#include <glm/gtc/quaternion.hpp>

namespace tweend::animation {
namespace {

/// T · R · S.
Affine local_matrix(const JointPose& joint) {
  const glm::mat3 r = glm::mat3_cast(joint.rotation);
  Affine local;
  for (int i = 0; i < 3; ++i) {
    local.rows[static_cast<std::size_t>(i)] = {r[0][i] * joint.scale.x, r[1][i] * joint.scale.y, r[2][i] * joint.scale.z,
                                               joint.translation[i]};
  }
  return local;
}

}  // namespace

void local_to_model(std::span<const std::int32_t> parents, const Pose& pose, std::span<Affine> model_from_joint) noexcept {
  for (std::size_t j = 0; j < parents.size(); ++j) {
    const Affine local = local_matrix(pose.joint(j));
    const std::int32_t parent = parents[j];
    model_from_joint[j] = parent < 0 ? local : multiply(model_from_joint[static_cast<std::size_t>(parent)], local);
  }
}

}  // namespace tweend::animation
