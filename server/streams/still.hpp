#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "render/render_thread.hpp"
#include "server/base/worker_pool.hpp"
#include "server/model/camera.hpp"
#include "server/stage/show.hpp"

namespace tweend::streams {

enum class ImageFormat : std::uint8_t { Png, Jpeg };

/// One picture of a scene.
struct StillRequest {
  stage::SceneViewPtr view;
  std::optional<double> time_s;  ///< of each actor's current clip, clamped to it; empty: what is shown at `now_us`
  ClockUs now_us = 0;
  render::Size size;
  ImageFormat format = ImageFormat::Png;
  int quality = 80;                            ///< of a JPEG, 1 to 100
  std::optional<model::CameraRequest> camera;  ///< empty: the scene's
};

struct Still {
  double time_s = 0.0;  ///< media time of the scene's first actor
  std::vector<std::byte> file;
};
struct DrawnStill {
  double time_s = 0.0;
  render::PixelsPtr pixels;
};

/// On a worker or the render thread.
using StillDone = std::function<void(Result<Still>)>;
/// On the render thread, which has others to serve.
using DrawnStillDone = std::function<void(Result<DrawnStill>)>;

/// Draws and encodes a picture; streams go first. Any thread; returns at once.
/// What can go wrong: Limit (too large for the device), Unavailable (no device, no memory).
void render_still(StillRequest request, WorkerPool& workers, render::RenderThread& renderer, StillDone done);
/// Only draws it.
void draw_still(StillRequest request, WorkerPool& workers, render::RenderThread& renderer, DrawnStillDone done);

}  // namespace tweend::streams
