#include "server/streams/scene_look.hpp"

#include <glm/geometric.hpp>

#include "server/streams/bone_sources.hpp"

namespace tweend::streams {
namespace {

render::View view_of(const model::Camera& camera, render::Size size) noexcept {
  const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
  return {model::view_from_world(camera), model::clip_from_view(camera, aspect), camera.eye,
          glm::distance(camera.eye, camera.target)};
}

}  // namespace

model::Camera SceneLook::camera_of(const model::ScenePtr& scene, const std::optional<model::CameraRequest>& own,
                                   render::Size size) {
  const model::Camera& of_scene = scene->settings.camera;
  if (!own) return of_scene;
  if (own->fit && fitted_ != scene) {
    fitted_ = scene;
    visible_ = model::visible_bounds(*scene);
  }
  const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
  const auto placed = model::place(of_scene, *own, visible_, aspect);
  return placed ? *placed : of_scene;
}

void SceneLook::look(const model::ScenePtr& scene, const std::optional<model::CameraRequest>& camera, render::Size size,
                     render::Picture& out) {
  out.size = size;
  out.view = view_of(camera_of(scene, camera, size), size);
  size_lone_balls(out.view.focus_m, out.bones);
  size_lone_balls(out.view.focus_m, out.bones_over);
}

}  // namespace tweend::streams
