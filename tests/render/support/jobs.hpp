#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <utility>

#include "render/render_thread.hpp"
#include "tests/render/support/image.hpp"

namespace tweend::render::test {

/// A job whose answer can be waited for, and which counts how often it was answered.
class WaitingJob : public FrameJob {
 public:
  /// @param when_asked  called on the render thread when it asks for the picture; may block it
  explicit WaitingJob(Picture picture, std::function<void()> when_asked = {})
      : picture_(std::move(picture)), when_asked_(std::move(when_asked)) {}

  [[nodiscard]] const Picture& picture() const noexcept override {
    if (when_asked_) when_asked_();
    return picture_;
  }
  void drawn(Result<PixelsPtr> pixels) noexcept override {
    if (answers_.fetch_add(1) == 0) answer_.set_value(std::move(pixels));
  }

  /// Waits; once only.
  [[nodiscard]] Result<PixelsPtr> wait() { return answer_.get_future().get(); }
  /// Waits, and copies the pixels.
  [[nodiscard]] Result<Image> wait_image() {
    Result<PixelsPtr> pixels = wait();
    if (!pixels) return pixels.error();
    return Image((*pixels)->view());
  }
  [[nodiscard]] int answers() const noexcept { return answers_; }

 private:
  const Picture picture_;
  const std::function<void()> when_asked_;
  std::promise<Result<PixelsPtr>> answer_;
  std::atomic<int> answers_{0};
};
using WaitingJobPtr = std::shared_ptr<WaitingJob>;

}  // namespace tweend::render::test
