#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "server/base/result.hpp"
#include "server/model/bounds.hpp"

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

/// Places the eye on a sphere around the target: eye = target + distance · (sin a cos e, sin e, cos a cos e),
/// a the azimuth from +Z towards +X, e the elevation above the XZ plane (radians).
[[nodiscard]] Camera orbit(Camera camera, float azimuth, float elevation, float distance) noexcept;

/// Keeps the direction and moves eye and target so that the whole box is in view in a picture of this shape;
/// near and far then bracket it generously. A box of no size is given one.
/// @param box     world space
/// @param aspect  width / height; a tall picture's narrower side counts
[[nodiscard]] Camera fit(Camera camera, const Bounds& box, float aspect = 1.0F) noexcept;

struct OrbitRequest {
  float azimuth = 0.0F;           ///< radians
  float elevation = 0.0F;         ///< radians
  std::optional<float> distance;  ///< metres; empty: as it is
  std::optional<glm::vec3> target;
  bool operator==(const OrbitRequest&) const = default;
};

/// What is asked of a camera; what is left out stays as it is.
struct CameraRequest {
  std::optional<glm::vec3> eye, target, up;
  std::optional<float> fov_y, near, far;
  std::optional<OrbitRequest> orbit;
  bool fit = false;
  bool operator==(const CameraRequest&) const = default;
};

/// The camera as asked. Fitting comes last but for near and far, which are taken as they are given.
/// @param visible  what `fit` brings into view; without it `fit` changes nothing
/// @param aspect   of the picture to be fitted into; that of a square fits every wide one
/// @return InvalidParams, path "eye", "up" or "near", where it could show nothing
[[nodiscard]] Result<Camera> place(Camera camera, const CameraRequest& request, const std::optional<Bounds>& visible,
                                   float aspect = 1.0F);

/// From world to view space: x right, y up, looking along -z.
[[nodiscard]] glm::mat4 view_from_world(const Camera& camera) noexcept;
/// The perspective projection to OpenGL's clip space (-w <= z <= w).
/// @param aspect  width / height
[[nodiscard]] glm::mat4 clip_from_view(const Camera& camera, float aspect) noexcept;

}  // namespace tweend::model
