#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "render/egl_context.hpp"
#include "render/picture.hpp"
#include "render/readback.hpp"
#include "server/base/result.hpp"

namespace tweend::render {

/// Somebody who wants a picture. Both functions are called on the render thread, which has others to serve: they hand on.
/// Only once it is stopping `drawn` is called by submit() itself, with an error.
class FrameJob {
 public:
  virtual ~FrameJob() = default;
  /// What to draw; asked once. Its spans must last until `drawn`.
  [[nodiscard]] virtual const Picture& picture() const noexcept = 0;
  /// The picture, or why there is none (Limit: too large; Unavailable: no device, no memory).
  virtual void drawn(Result<PixelsPtr> pixels) noexcept = 0;
};

struct RenderOptions {
  int samples = 0;                                ///< a pixel; 0: 4 on a GPU, 1 on a software device
  std::size_t gpu_bytes = std::size_t{1} << 30U;  ///< for meshes and keyframes
  bool off = false;                               ///< draw nothing: every job is refused
};

/// The one thread that owns the GL context. Pictures are drawn earliest deadline first; while one is drawn the one before
/// is read back, and whoever was given the one before that encodes it. Nothing here waits for more work to come: as soon as
/// the GPU has finished a picture it is read and handed on.
class RenderThread {
 public:
  /// Opens the context; where there is none, every job is answered with the reason.
  explicit RenderThread(RenderOptions options = {});
  ~RenderThread();  ///< stop()
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  /// What draws ("llvmpipe …"), or why nothing does.
  [[nodiscard]] const Result<std::string>& device() const noexcept { return device_; }
  /// The longest side of a picture that the device draws, pixels; 0 where there is none.
  [[nodiscard]] std::uint32_t largest_side() const noexcept { return largest_side_; }
  /// Whether there should be one.
  [[nodiscard]] bool wanted() const noexcept { return wanted_; }
  [[nodiscard]] const std::vector<DeviceAttempt>& attempts() const noexcept { return attempts_; }

  /// Any thread. The job is kept until it has been answered; it must not be submitted again before.
  /// @param deadline_us  a reading of any clock, the same for all jobs: the earliest is drawn first
  void submit(std::shared_ptr<FrameJob> job, std::int64_t deadline_us);
  /// Draws what waits, answers it, joins. Every picture must come back: who holds one is waited for. One thread only, and
  /// not the render thread.
  void stop();

 private:
  struct Waiting {
    std::shared_ptr<FrameJob> job;
    std::int64_t deadline_us;
  };
  class Loop;
  void run(RenderOptions options, std::promise<void> opened);

  const bool wanted_;
  Result<std::string> device_{Error{}};
  std::uint32_t largest_side_ = 0;
  std::vector<DeviceAttempt> attempts_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Waiting> waiting_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace tweend::render
