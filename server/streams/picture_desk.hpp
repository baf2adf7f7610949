#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "render/render_thread.hpp"
#include "server/base/worker_pool.hpp"
#include "server/model/camera.hpp"
#include "server/stage/show.hpp"
#include "server/streams/scene_moment.hpp"

namespace tweend::streams {

class SharedDrawing;

/// Who wants a picture. Called on the strand.
class PictureUser {
 public:
  virtual ~PictureUser() = default;
  /// The picture, or why there is none (Limit: too large; Unavailable: no device, no memory).
  virtual void drawn(const Result<render::PixelsPtr>& pixels) = 0;
};

/// Where producers of pictures order them, so that what several of them need is made once: a moment of a scene is read and
/// composed once for all that look at it, and drawn once for all that look the same way. Lives on the stage's strand; all
/// memory is kept and used again. Outlives the strand's work.
class PictureDesk {
 public:
  PictureDesk(boost::asio::io_context& strand, WorkerPool& workers, render::RenderThread& renderer);
  ~PictureDesk();
  PictureDesk(const PictureDesk&) = delete;
  PictureDesk& operator=(const PictureDesk&) = delete;

  /// What a view shows at a reading of the clock, read now unless somebody has it.
  [[nodiscard]] MomentPtr moment(const stage::SceneViewPtr& view, ClockUs at_us);

  /// Has a picture of a moment drawn; the user is told. One that is on its way for somebody else is shared.
  /// @param camera       empty, or one that can show nothing of this scene: the scene's
  /// @param deadline_us  the earliest is drawn first
  void draw(const MomentPtr& moment, const std::optional<model::CameraRequest>& camera, render::Size size, ClockUs deadline_us,
            std::shared_ptr<PictureUser> user);

  /// Lets go of memory that nobody uses now.
  void trim();
  /// The workers are about to stop: what they have not been given yet is not made.
  void stop() noexcept { stopping_ = true; }

 private:
  friend class SharedDrawing;
  void compose_and_submit(SharedDrawing& drawing);
  void composed(const MomentPtr& moment);
  void finished(SharedDrawing& drawing);

  boost::asio::io_context& strand_;
  WorkerPool& workers_;
  render::RenderThread& renderer_;
  std::vector<MomentPtr> moments_;
  std::vector<std::shared_ptr<SharedDrawing>> drawings_;
  std::vector<std::shared_ptr<PictureUser>> told_;
  bool stopping_ = false;
};

}  // namespace tweend::streams
