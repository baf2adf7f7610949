#pragma once

#include <memory>
#include <string>

#include "render/render_thread.hpp"
#include "server/assets/asset_library.hpp"
#include "server/base/limits.hpp"
#include "server/base/metrics.hpp"
#include "server/base/worker_pool.hpp"
#include "server/commands/event_hub.hpp"
#include "server/stage/stage.hpp"
#include "server/streams/clip_film.hpp"
#include "server/streams/hub.hpp"
#include "server/streams/recorder.hpp"
#include "server/streams/still_queue.hpp"

namespace tweend::commands {

/// What handlers work with. Outlives every conversation.
struct Services {
  const Limits& limits;
  Metrics& metrics;
  const assets::AssetLibrary& assets;
  stage::Stage& stage;
  streams::Hub& hub;
  EventHub& events;
  WorkerPool& workers;
  render::RenderThread& renderer;
  streams::StillQueue& stills;
  streams::Recorder& recorder;
  streams::FilmQueue& films;
};

}  // namespace tweend::commands
