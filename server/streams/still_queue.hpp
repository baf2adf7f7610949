#pragma once

#include <cstddef>
#include <deque>
#include <mutex>
#include <utility>

#include "server/streams/still.hpp"

namespace tweend::streams {

/// Single pictures, few at a time: a crowd that asks for large ones takes neither the render thread, nor the workers, nor the
/// memory from streams and commands. Any thread; outlives what it was asked for.
class StillQueue {
 public:
  /// How many requests may wait; the next one is refused.
  static constexpr std::size_t kWaiting = 1'024;

  /// @param at_once  from the first step to the encoded file
  StillQueue(WorkerPool& workers, render::RenderThread& renderer, std::size_t at_once)
      : workers_(workers), renderer_(renderer), at_once_(at_once) {}

  /// As render_still. @return Unavailable where too many wait already; `done` is not called then
  [[nodiscard]] Status render(StillRequest request, StillDone done);

 private:
  void begin(StillRequest request, StillDone done);
  void ended();

  WorkerPool& workers_;
  render::RenderThread& renderer_;
  const std::size_t at_once_;
  std::mutex mutex_;
  std::deque<std::pair<StillRequest, StillDone>> waiting_;
  std::size_t under_way_ = 0;
};

}  // namespace tweend::streams
