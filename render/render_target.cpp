#include "render/render_target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "render/gl_error.hpp"

namespace tweend::render {
namespace {

/// What a pool keeps at most, the target that was used last in any case: four of 1280 × 720.
constexpr std::size_t kKept = 8;
constexpr std::size_t kKeptBytes = std::size_t{32} << 20U;

}  // namespace

Result<RenderTargetPtr> RenderTarget::make(Size size, int samples) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  const auto most = static_cast<std::uint32_t>(largest);
  if (size.width == 0 || size.height == 0 || size.width > most || size.height > most) {
    return fail(ErrorCode::Limit,
                fmt::format("expected a picture of 1 x 1 to {0} x {0} pixels, the most this device draws, found {1} x {2}",
                            most, size.width, size.height));
  }
  static_cast<void>(take_gl_error());  // not ours
  std::unique_ptr<RenderTarget> target(new RenderTarget);
  target->size_ = size;
  target->samples_ = samples;
  bool complete = target->attach(target->drawn_, samples, true);
  if (samples > 1) {
    target->resolved_ = std::make_unique<Attachments>();
    complete = target->attach(*target->resolved_, 1, false) && complete;
  }
  if (take_gl_error() == GL_NO_ERROR && complete) return target;
  return fail(ErrorCode::Unavailable,
              fmt::format("expected memory for a picture of {} x {} pixels, {} samples each, found none; "
                          "ask for a smaller one",
                          size.width, size.height, samples));
}

bool RenderTarget::attach(Attachments& to, int samples, bool depth) const {
  const auto width = static_cast<GLsizei>(size_.width);
  const auto height = static_cast<GLsizei>(size_.height);
  const GLsizei several = samples > 1 ? samples : 0;
  glNamedRenderbufferStorageMultisample(to.color.name(), several, GL_SRGB8_ALPHA8, width, height);
  glNamedFramebufferRenderbuffer(to.framebuffer.name(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, to.color.name());
  if (depth) {
    to.depth = GlRenderbuffer::make();
    glNamedRenderbufferStorageMultisample(to.depth.name(), several, GL_DEPTH_COMPONENT24, width, height);
    glNamedFramebufferRenderbuffer(to.framebuffer.name(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, to.depth.name());
  }
  return glCheckNamedFramebufferStatus(to.framebuffer.name(), GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

void RenderTarget::resolve() const {
  if (!resolved_) return;
  const auto width = static_cast<GLint>(size_.width);
  const auto height = static_cast<GLint>(size_.height);
  glBlitNamedFramebuffer(drawn_.framebuffer.name(), resolved_->framebuffer.name(), 0, 0, width, height, 0, 0, width, height,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void RenderTarget::read_into(GLuint buffer) const {
  const Attachments& from = resolved_ ? *resolved_ : drawn_;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from.framebuffer.name());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, static_cast<GLsizei>(size_.width), static_cast<GLsizei>(size_.height), GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

Result<RenderTargetPtr> RenderTargetPool::take(Size size) {
  const auto fits = std::find_if(free_.rbegin(), free_.rend(), [size](const RenderTargetPtr& t) { return t->size() == size; });
  if (fits == free_.rend()) return RenderTarget::make(size, samples_);
  RenderTargetPtr target = std::move(*fits);
  free_.erase(std::next(fits).base());
  return target;
}

void RenderTargetPool::give_back(RenderTargetPtr target) {
  free_.push_back(std::move(target));
  std::size_t kept = 0;
  for (const RenderTargetPtr& free : free_) kept += free->bytes();
  while (free_.size() > 1 && (free_.size() > kKept || kept > kKeptBytes)) {
    kept -= free_.front()->bytes();
    free_.erase(free_.begin());
  }
}

}  // namespace tweend::render
