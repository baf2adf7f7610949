#pragma once

#include <vector>

#include "render/picture.hpp"
#include "server/model/camera.hpp"
#include "server/stage/show.hpp"

namespace tweend::streams {

/// Turns what a scene shows into what is to be drawn: which keyframes of each actor with what weights, matrices, light.
/// Keeps its memory from picture to picture. One thread at a time; the picture's spans last as long as the show.
class FrameComposer {
 public:
  /// @param camera  empty, or one that can show nothing of this scene: the scene's
  void compose(const stage::Show& show, const std::optional<model::CameraRequest>& camera, render::Size size,
               render::Picture& out);

 private:
  /// What the renderer is told of an actor's mesh, made again only when it changes.
  struct KnownMesh {
    model::MeshPtr mesh;
    render::MeshSourcePtr source;
  };
  void add_actor(const stage::ActorShow& show, std::size_t index, render::Picture& out);

  [[nodiscard]] model::Camera camera_of(const model::ScenePtr& scene, const std::optional<model::CameraRequest>& own,
                                        render::Size size);

  std::vector<KnownMesh> meshes_;  ///< by the actor's index
  model::ScenePtr fitted_;         ///< what `visible_` holds; it takes a look at every keyframe
  std::optional<model::Bounds> visible_;
};

}  // namespace tweend::streams
