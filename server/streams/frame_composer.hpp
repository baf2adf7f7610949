#pragma once

#include <optional>
#include <vector>

#include "render/picture.hpp"
#include "server/model/camera.hpp"
#include "server/model/evaluate.hpp"
#include "server/stage/show.hpp"
#include "server/streams/scene_look.hpp"

namespace tweend::streams {

/// Turns what a scene shows into what is to be drawn: which keyframes of each actor with what weights, which palette and which
/// morph weights, matrices, bones, light. Keeps its memory from picture to picture. One thread at a time; the picture's spans
/// last as long as the show, this composer, and until it composes again.
class FrameComposer {
 public:
  /// What is there, whoever looks: all of a picture but its size and view.
  void compose(const stage::Show& show, render::Picture& out);
  /// The same and a look at it.
  void compose(const stage::Show& show, const std::optional<model::CameraRequest>& camera, render::Size size,
               render::Picture& out);

 private:
  /// What is kept of an actor: what the renderer is told of its model, made again only when that changes, and memory.
  struct Slot {
    model::ModelPtr model;
    render::MeshSourcePtr source;  ///< null without a mesh
    model::Evaluator evaluator;
    std::vector<float> vertices;  ///< where neither keyframes nor a pose say all
  };
  static void add_actor(const stage::ActorShow& show, Slot& slot, render::Picture& out);
  static void set_pose(const stage::ActorShow& show, Slot& slot, render::DrawItem& item);
  static void set_vertices(const stage::ActorShow& show, Slot& slot, render::DrawItem& item);

  std::vector<Slot> slots_;  ///< by the actor's index
  SceneLook look_;
};

}  // namespace tweend::streams
