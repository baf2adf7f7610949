#pragma once

#include <optional>

#include "render/picture.hpp"
#include "server/model/actor_bounds.hpp"
#include "server/model/camera.hpp"
#include "server/model/scene.hpp"

namespace tweend::streams {

/// From where a picture is looked at. Keeps what a fitted camera has to know of its scene. One thread at a time.
class SceneLook {
 public:
  /// Sets size and view of a picture that has been composed.
  /// @param camera  empty, or one that can show nothing of this scene: the scene's
  void look(const model::ScenePtr& scene, const std::optional<model::CameraRequest>& camera, render::Size size,
            render::Picture& out);

 private:
  [[nodiscard]] model::Camera camera_of(const model::ScenePtr& scene, const std::optional<model::CameraRequest>& own,
                                        render::Size size);

  model::ScenePtr fitted_;  ///< what `visible_` holds; it takes a look at every keyframe
  std::optional<model::Bounds> visible_;
};

}  // namespace tweend::streams
