#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/gl_handle.hpp"
#include "render/picture.hpp"
#include "server/base/result.hpp"

namespace tweend::render {

/// Where a picture is drawn: an sRGB colour buffer and depth, with several samples a pixel if asked for.
/// The context's thread only.
class RenderTarget {
 public:
  /// @return Limit naming the device's largest size, Unavailable if it has no memory left
  [[nodiscard]] static Result<std::unique_ptr<RenderTarget>> make(Size size, int samples);

  [[nodiscard]] Size size() const noexcept { return size_; }
  [[nodiscard]] int samples() const noexcept { return samples_; }
  /// Of colour and depth, about.
  [[nodiscard]] std::size_t bytes() const noexcept {
    return std::size_t{8} * size_.width * size_.height * static_cast<std::size_t>(samples_);
  }
  /// What is drawn to.
  [[nodiscard]] GLuint framebuffer() const noexcept { return drawn_.framebuffer.name(); }
  /// Makes one sample of each pixel's several.
  void resolve() const;
  /// Reads the pixels, once they are drawn and resolved, into a buffer object.
  void read_into(GLuint buffer) const;

 private:
  RenderTarget() = default;
  struct Attachments {
    GlFramebuffer framebuffer = GlFramebuffer::make();
    GlRenderbuffer color = GlRenderbuffer::make();
    GlRenderbuffer depth;
  };
  [[nodiscard]] bool attach(Attachments& to, int samples, bool depth) const;

  Size size_;
  int samples_ = 1;
  Attachments drawn_;
  std::unique_ptr<Attachments> resolved_;  ///< only with several samples
};
using RenderTargetPtr = std::unique_ptr<RenderTarget>;

/// Targets that are free, the one given back last first: as many as there are views at work, and a few more.
class RenderTargetPool {
 public:
  explicit RenderTargetPool(int samples) : samples_(samples) {}
  [[nodiscard]] Result<RenderTargetPtr> take(Size size);
  void give_back(RenderTargetPtr target);

 private:
  const int samples_;
  std::vector<RenderTargetPtr> free_;
};

}  // namespace tweend::render
