#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace tweend::animation {

/// Local transform of one joint relative to its parent: scaled, then rotated, then moved.
struct JointPose {
  glm::vec3 translation{0.0F};                 ///< metres
  glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};  ///< unit; constructor w,x,y,z, wire and glTF x,y,z,w
  glm::vec3 scale{1.0F};
  bool operator==(const JointPose&) const = default;
};

}  // namespace tweend::animation
