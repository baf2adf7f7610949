#include "server/assets/gltf_transform.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>
#include <vector>

namespace tweend::assets {
namespace {

constexpr double kNoLength = 1e-30;
constexpr double kShear = 1e-3;  // cosine of the angle between two axes that is still taken for a right one

/// Axes of length 0 (how exporters hide things) become unit axes at right angles to the others.
void complete_axes(std::array<glm::dvec3, 3>& axes, const std::array<bool, 3>& given) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (given[i]) continue;
    const glm::dvec3& a = axes[(i + 1) % 3];
    const glm::dvec3& b = axes[(i + 2) % 3];
    const bool has_a = given[(i + 1) % 3] || i > (i + 1) % 3;
    const bool has_b = given[(i + 2) % 3] || i > (i + 2) % 3;
    if (has_a && has_b) {
      axes[i] = glm::normalize(glm::cross(a, b));
    } else if (has_a || has_b) {
      const glm::dvec3& one = has_a ? a : b;
      const glm::dvec3 aside = std::abs(one.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
      axes[i] = glm::normalize(glm::cross(one, aside));
    } else {
      axes[i] = glm::dvec3(0);
      axes[i][static_cast<glm::length_t>(i)] = 1.0;
    }
  }
}

/// Scale and rotation of a matrix's first three columns. @return whether nothing is lost
bool take_apart(std::array<glm::dvec3, 3> axes, animation::JointPose& pose) {
  std::array<bool, 3> given{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = glm::length(axes[i]);
    pose.scale[static_cast<glm::length_t>(i)] = static_cast<float>(length);
    given[i] = length > kNoLength;
    if (given[i]) axes[i] /= length;
  }
  complete_axes(axes, given);
  bool right_angles = true;
  for (std::size_t i = 0; i < 3; ++i) right_angles &= std::abs(glm::dot(axes[i], axes[(i + 1) % 3])) < kShear;
  if (glm::dot(glm::cross(axes[0], axes[1]), axes[2]) < 0.0) {  // a mirror image: no rotation makes one
    axes[0] = -axes[0];
    pose.scale.x = -pose.scale.x;
  }
  axes[1] -= axes[0] * glm::dot(axes[0], axes[1]);
  axes[1] = glm::length(axes[1]) > kNoLength ? glm::normalize(axes[1]) : axes[1];
  axes[2] = glm::cross(axes[0], axes[1]);
  const glm::dquat rotation = glm::quat_cast(glm::dmat3(axes[0], axes[1], axes[2]));
  if (!(glm::length(rotation) > kNoLength)) return false;
  pose.rotation = glm::quat(glm::normalize(rotation));
  return right_angles;
}

Result<animation::JointPose> read_matrix(const JsonNode& matrix, GltfWarnings& warnings) {
  TWEEND_ASSIGN(const std::vector<float> m, matrix.floats(16));
  if (m[3] != 0.0F || m[7] != 0.0F || m[11] != 0.0F || m[15] != 1.0F) {
    return matrix.error("expected a matrix whose last row is 0 0 0 1, found another");
  }
  animation::JointPose pose;
  pose.translation = {m[12], m[13], m[14]};
  const std::array<glm::dvec3, 3> axes{glm::dvec3(m[0], m[1], m[2]), glm::dvec3(m[4], m[5], m[6]),
                                       glm::dvec3(m[8], m[9], m[10])};
  if (!take_apart(axes, pose)) {
    warnings.add(matrix, "expected a matrix of translation, rotation and scale, found a shear too, which is left out");
  }
  return pose;
}

Result<glm::vec3> read_vector(const JsonNode& node, std::string_view key, const glm::vec3& fallback) {
  const auto member = node.find(key);
  if (!member) return fallback;
  TWEEND_ASSIGN(const std::vector<float> v, member->floats(3));
  return glm::vec3(v[0], v[1], v[2]);
}

}  // namespace

Result<animation::JointPose> read_gltf_transform(const JsonNode& node, GltfWarnings& warnings) {
  if (const auto matrix = node.find("matrix")) {
    for (const std::string_view other : {"translation", "rotation", "scale"}) {
      if (const auto beside = node.find(other)) return beside->error("expected none beside a matrix, found both");
    }
    return read_matrix(*matrix, warnings);
  }
  animation::JointPose pose;
  TWEEND_ASSIGN(pose.translation, read_vector(node, "translation", pose.translation));
  TWEEND_ASSIGN(pose.scale, read_vector(node, "scale", pose.scale));
  if (const auto rotation = node.find("rotation")) {
    TWEEND_ASSIGN(const std::vector<float> q, rotation->floats(4));
    const glm::dquat wide(q[3], q[0], q[1], q[2]);
    const double length = glm::length(wide);
    if (!(length > kNoLength)) return rotation->error("expected a unit quaternion, found one of length 0");
    pose.rotation = glm::quat(wide / length);
  }
  return pose;
}

}  // namespace tweend::assets
