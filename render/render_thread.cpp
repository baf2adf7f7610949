#include "render/render_thread.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <utility>

#include "render/gl_error.hpp"
#include "render/render_target.hpp"
#include "render/renderer.hpp"

namespace tweend::render {
namespace {

/// Pictures on the GPU at once: one being drawn, one done and about to be read. More would only grow older.
constexpr std::size_t kInFlight = 2;
/// How long the GPU is waited for before the queue is looked at again, nanoseconds.
constexpr GLuint64 kPatience = 1'000'000;

constexpr int kSamplesOnGpu = 4;

Result<std::unique_ptr<EglContext>> switched_off() {
  return fail(ErrorCode::Unavailable, "expected a server that draws, found one started with --no-render");
}

std::uint32_t supported_side() {
  GLint side = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &side);
  return static_cast<std::uint32_t>(side);
}

int supported_samples(int wanted, bool software) {
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  if (wanted == 0) wanted = software ? 1 : kSamplesOnGpu;
  return std::clamp(wanted, 1, static_cast<int>(most));
}

/// llvmpipe takes its memory for each picture anew, tens of megabytes for 100,000 triangles, in pieces of 64 KiB, and gives
/// all of it back at the end. By default the C library then hands it on to the kernel, and the next picture begins with
/// thousands of page faults.
void keep_freed_memory() {
  constexpr int kMiB = 1 << 20;
  mallopt(M_TRIM_THRESHOLD, 128 * kMiB);
  // Setting one stops the C library from adapting the other: this is where it would get to by itself.
  mallopt(M_MMAP_THRESHOLD, 32 * kMiB);
}

}  // namespace

/// The work of the thread, once there is a context.
class RenderThread::Loop {
 public:
  Loop(std::unique_ptr<Renderer> renderer, int samples) : renderer_(std::move(renderer)), targets_(samples) {}
  ~Loop() {
    for (const GLsync fence : kept_) glDeleteSync(fence);
  }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  [[nodiscard]] bool busy() const noexcept { return !in_flight_.empty(); }
  [[nodiscard]] bool has_room() const noexcept { return in_flight_.size() < kInFlight; }

  void draw(std::shared_ptr<FrameJob> job) {
    const Picture& picture = job->picture();
    Result<RenderTargetPtr> target = targets_.take(picture.size);
    if (!target) return job->drawn(target.error());
    PixelsPtr pixels = readback_.take(picture.size);
    if (!pixels) {
      targets_.give_back(std::move(*target));
      return job->drawn(no_memory(picture.size));
    }
    renderer_->draw(picture, **target);
    if (take_gl_error() == GL_OUT_OF_MEMORY) {
      // Some mesh has no memory behind it now; it must not be taken for uploaded.
      renderer_->cache().forget();
      targets_.give_back(std::move(*target));
      pixels.reset();
      return job->drawn(no_memory(picture.size));
    }
    in_flight_.push_back({std::move(job), std::move(*target), std::move(pixels), fence(), false});
  }

  /// Takes the oldest picture a step further if the GPU is done with the step before, or is within `timeout_ns`.
  /// @return whether it was
  bool advance(GLuint64 timeout_ns) {
    InFlight& oldest = in_flight_.front();
    const GLenum state = glClientWaitSync(oldest.fence, GL_SYNC_FLUSH_COMMANDS_BIT, timeout_ns);
    if (state == GL_TIMEOUT_EXPIRED) return false;
    if (state == GL_WAIT_FAILED) {
      InFlight lost = std::move(oldest);
      in_flight_.pop_front();
      glDeleteSync(lost.fence);
      lost.job->drawn(
          fail(ErrorCode::Unavailable, "expected the GPU to finish a picture, found its context lost; restart the server"));
      return true;
    }
    glDeleteSync(oldest.fence);
    if (!oldest.reading) {
      // Only now: a software device would draw the whole picture inside this call, with everyone waiting.
      oldest.target->read_into(oldest.pixels->buffer());
      oldest.reading = true;
      oldest.fence = fence();
      return true;
    }
    InFlight done = std::move(oldest);
    in_flight_.pop_front();
    const Size size = done.target->size();
    targets_.give_back(std::move(done.target));
    readback_.trim();
    if (take_gl_error() == GL_OUT_OF_MEMORY) {
      done.job->drawn(no_memory(size));
    } else {
      done.job->drawn(std::move(done.pixels));
    }
    return true;
  }

 private:
  struct InFlight {
    std::shared_ptr<FrameJob> job;
    RenderTargetPtr target;
    PixelsPtr pixels;
    GLsync fence;
    bool reading;  ///< what the fence stands behind: reading, else drawing
  };

  /// Mesa's llvmpipe (22.3) calls a fence passed while the thread that reports so still holds the fence's lock, and frees it
  /// with its last reference, lock and all; a wait that succeeds lets go of one. So each fence gets a second sync object that
  /// nobody waits for, until younger fences have passed: the threads report one after the other. Pictures so large that
  /// llvmpipe draws them in several goes have fences between that nobody can keep.
  GLsync fence() {
    GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glDeleteSync(std::exchange(kept_[next_kept_], glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)));
    next_kept_ = (next_kept_ + 1) % kept_.size();
    glFlush();
    return fence;
  }
  static Error no_memory(Size size) {
    return fail(ErrorCode::Unavailable,
                fmt::format("expected GPU memory for a picture of {} x {} pixels, found none; ask for a smaller one",
                            size.width, size.height));
  }

  std::unique_ptr<Renderer> renderer_;
  RenderTargetPool targets_;
  ReadbackPool readback_;
  std::deque<InFlight> in_flight_;
  std::array<GLsync, 4 * kInFlight> kept_{};  ///< null: none yet, which deletes nothing
  std::size_t next_kept_ = 0;
};

RenderThread::RenderThread(RenderOptions options) : wanted_(!options.off) {
  std::promise<void> opened;
  std::future<void> ready = opened.get_future();
  thread_ = std::thread([this, options, promise = std::move(opened)]() mutable { run(options, std::move(promise)); });
  ready.wait();
}

RenderThread::~RenderThread() { stop(); }

void RenderThread::submit(std::shared_ptr<FrameJob> job, std::int64_t deadline_us) {
  std::unique_lock lock(mutex_);
  if (stopping_) {
    lock.unlock();
    return job->drawn(fail(ErrorCode::Unavailable, "expected a server that draws, found it stopping"));
  }
  const auto later =
      std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& w) { return w.deadline_us > deadline_us; });
  waiting_.insert(later, {std::move(job), deadline_us});
  lock.unlock();
  changed_.notify_one();
}

void RenderThread::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void RenderThread::run(RenderOptions options, std::promise<void> opened) {
  Result<std::unique_ptr<EglContext>> context = options.off ? switched_off() : EglContext::open(&attempts_);
  std::unique_ptr<Loop> loop;
  if (context) {
    Result<std::unique_ptr<Renderer>> renderer = Renderer::make(options.gpu_bytes);
    if (renderer) {
      const int samples = supported_samples(options.samples, (*context)->software());
      loop = std::make_unique<Loop>(std::move(*renderer), samples);
      largest_side_ = supported_side();
      device_ = fmt::format("{}, {} sample{} a pixel", (*context)->description(), samples, samples == 1 ? "" : "s");
    } else {
      device_ = renderer.error();
    }
  } else {
    device_ = context.error();
  }
  if (context && (*context)->software()) keep_freed_memory();
  opened.set_value();

  for (;;) {
    std::shared_ptr<FrameJob> next;
    {
      std::unique_lock lock(mutex_);
      if (!loop || !loop->busy()) changed_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
      if (!waiting_.empty() && (!loop || loop->has_room())) {
        next = std::move(waiting_.front().job);
        waiting_.erase(waiting_.begin());
      } else if (stopping_ && (!loop || !loop->busy())) {
        break;
      }
    }
    if (next && !loop) {
      next->drawn(device_.error());
      continue;
    }
    const bool drew = next != nullptr;
    if (drew) loop->draw(std::move(next));
    while (loop && loop->busy() && loop->advance(0)) continue;
    // With nothing else to do, sleep until the GPU has a step done; not for long: somebody may come with more work.
    if (!drew && loop && loop->busy()) loop->advance(kPatience);
  }
  loop.reset();  // before the context
}

}  // namespace tweend::render
