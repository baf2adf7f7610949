#include "server/model/camera.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tweend::model {

Camera orbit(Camera camera, float azimuth, float elevation, float distance) noexcept {
  const glm::vec3 direction(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                            std::cos(azimuth) * std::cos(elevation));
  camera.eye = camera.target + distance * direction;
  return camera;
}

Camera fit(Camera camera, const Sphere& sphere) noexcept {
  constexpr float kMargin = 1.05F;
  const float radius = std::max(sphere.radius, 1e-3F) * kMargin;
  glm::vec3 back = camera.eye - camera.target;
  back = glm::length(back) > 0.0F ? glm::normalize(back) : glm::vec3(0.0F, 0.0F, 1.0F);
  // The cone of the field of view touches the ball at this distance (sin, not tan: a ball, not a disc).
  const float distance = radius / std::sin(camera.fov_y / 2.0F);
  camera.target = sphere.center;
  camera.eye = sphere.center + distance * back;
  camera.near = std::max((distance - radius) * 0.1F, distance * 1e-3F);
  camera.far = (distance + radius) * 10.0F;
  return camera;
}

}  // namespace tweend::model
