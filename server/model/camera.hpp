#pragma once

#include <glm/vec3.hpp>

namespace tweend::model {

/// A perspective camera in world space (glTF's conventions: it looks along -Z, +Y is up).
struct Camera {
  glm::vec3 eye{0.0F, 2.0F, 10.0F};
  glm::vec3 target{0.0F};
  glm::vec3 up{0.0F, 1.0F, 0.0F};
  float fov_y = 0.785398163F;  ///< radians, the whole vertical angle
  float near = 0.1F;           ///< metres
  float far = 500.0F;          ///< metres
  bool operator==(const Camera&) const = default;
};

/// A ball that holds what should be seen, world space, metres.
struct Sphere {
  glm::vec3 center{0.0F};
  float radius = 0.0F;
};

/// Places the eye on a sphere around the target: eye = target + distance · (sin a cos e, sin e, cos a cos e),
/// a the azimuth from +Z towards +X, e the elevation above the XZ plane (radians).
[[nodiscard]] Camera orbit(Camera camera, float azimuth, float elevation, float distance) noexcept;

/// Keeps the direction and moves eye and target so that the whole ball is in view at any aspect ratio from 1:1 up;
/// near and far then bracket it generously. A ball of no radius is given one.
[[nodiscard]] Camera fit(Camera camera, const Sphere& sphere) noexcept;

}  // namespace tweend::model
