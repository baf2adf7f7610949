#include "server/model/camera.hpp"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

namespace tweend::model {

Camera orbit(Camera camera, float azimuth, float elevation, float distance) noexcept {
  const glm::vec3 direction(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                            std::cos(azimuth) * std::cos(elevation));
  camera.eye = camera.target + distance * direction;
  return camera;
}

Camera fit(Camera camera, const Bounds& box, float aspect) noexcept {
  constexpr float kMargin = 1.05F;
  const glm::vec3 center = (box.min + box.max) * 0.5F;
  const float radius = std::max(glm::length(box.max - box.min) * 0.5F, 1e-3F) * kMargin;
  glm::vec3 back = camera.eye - camera.target;
  back = glm::length(back) > 0.0F ? glm::normalize(back) : glm::vec3(0.0F, 0.0F, 1.0F);
  glm::vec3 right = glm::cross(camera.up, back);
  // Looking along `up` any side is as good as another; such a camera is refused later.
  right = glm::length(right) > 0.0F ? glm::normalize(right) : glm::vec3(1.0F, 0.0F, 0.0F);
  const glm::vec3 up = glm::cross(back, right);

  // How far each corner has to be from the eye for the picture's sides to be beyond it.
  const float half_height = std::tan(camera.fov_y / 2.0F);
  const float half_width = half_height * aspect;
  float distance = 0.0F, nearest = -radius;
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 corner = kMargin * (glm::vec3((i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                                                  (i & 4) != 0 ? box.max.z : box.min.z) -
                                        center);
    // Not less than a tenth of the whole: of a rod seen from its end there is still something to keep away from.
    const float x = std::max(std::abs(glm::dot(corner, right)), 0.1F * radius);
    const float y = std::max(std::abs(glm::dot(corner, up)), 0.1F * radius);
    const float z = glm::dot(corner, back);
    distance = std::max({distance, z + x / half_width, z + y / half_height});
    nearest = std::max(nearest, z);
  }
  camera.target = center;
  camera.eye = center + distance * back;
  camera.near = std::max((distance - nearest) * 0.1F, distance * 1e-4F);
  camera.far = (distance + radius) * 10.0F;
  return camera;
}

namespace {

Status check(const Camera& camera) {
  const glm::vec3 forward = camera.target - camera.eye;
  if (!(glm::length(forward) > 0.0F)) {
    return fail(ErrorCode::InvalidParams, "expected eye and target to be apart, found them at one place", "eye");
  }
  if (!(glm::length(glm::cross(glm::normalize(forward), camera.up)) > 1e-6F)) {
    return fail(ErrorCode::InvalidParams, "expected up to point aside from the view, found it along it (or zero)", "up");
  }
  if (!(camera.near < camera.far)) return fail(ErrorCode::InvalidParams, "expected near to be less than far", "near");
  return {};
}

}  // namespace

Result<Camera> place(Camera camera, const CameraRequest& request, const std::optional<Bounds>& visible, float aspect) {
  camera.eye = request.eye.value_or(camera.eye);
  camera.target = request.target.value_or(camera.target);
  camera.up = request.up.value_or(camera.up);
  camera.fov_y = request.fov_y.value_or(camera.fov_y);
  if (request.orbit) {
    camera.target = request.orbit->target.value_or(camera.target);
    const float distance = request.orbit->distance.value_or(glm::length(camera.eye - camera.target));
    camera = orbit(camera, request.orbit->azimuth, request.orbit->elevation, distance);
  }
  if (request.fit && visible) camera = fit(camera, *visible, aspect);
  camera.near = request.near.value_or(camera.near);
  camera.far = request.far.value_or(camera.far);
  TWEEND_TRY(check(camera));
  return camera;
}

glm::mat4 view_from_world(const Camera& camera) noexcept { return glm::lookAt(camera.eye, camera.target, camera.up); }

glm::mat4 clip_from_view(const Camera& camera, float aspect) noexcept {
  return glm::perspective(camera.fov_y, aspect, camera.near, camera.far);
}

}  // namespace tweend::model
