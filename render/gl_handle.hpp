#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace tweend::render {

/// Owns one GL object; made and let go on the context's thread.
template <class Traits>
class GlHandle {
 public:
  GlHandle() = default;
  /// The object that Traits::make gives for the arguments.
  template <class... Args>
  [[nodiscard]] static GlHandle make(Args... args) {
    GlHandle handle;
    handle.name_ = Traits::make(args...);
    return handle;
  }
  ~GlHandle() { reset(); }
  GlHandle(GlHandle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlHandle& operator=(GlHandle&& other) noexcept {
    if (this != &other) {
      reset();
      name_ = std::exchange(other.name_, 0);
    }
    return *this;
  }
  GlHandle(const GlHandle&) = delete;
  GlHandle& operator=(const GlHandle&) = delete;

  [[nodiscard]] GLuint name() const noexcept { return name_; }
  explicit operator bool() const noexcept { return name_ != 0; }

 private:
  void reset() noexcept {
    if (name_ != 0) Traits::remove(std::exchange(name_, 0));
  }
  GLuint name_ = 0;
};

struct BufferTraits {
  static GLuint make() {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    return name;
  }
  static void remove(GLuint name) { glDeleteBuffers(1, &name); }
};
struct VertexArrayTraits {
  static GLuint make() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    return name;
  }
  static void remove(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct TextureTraits {
  static GLuint make(GLenum target) {
    GLuint name = 0;
    glCreateTextures(target, 1, &name);
    return name;
  }
  static void remove(GLuint name) { glDeleteTextures(1, &name); }
};
struct SamplerTraits {
  static GLuint make() {
    GLuint name = 0;
    glCreateSamplers(1, &name);
    return name;
  }
  static void remove(GLuint name) { glDeleteSamplers(1, &name); }
};
struct RenderbufferTraits {
  static GLuint make() {
    GLuint name = 0;
    glCreateRenderbuffers(1, &name);
    return name;
  }
  static void remove(GLuint name) { glDeleteRenderbuffers(1, &name); }
};
struct FramebufferTraits {
  static GLuint make() {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    return name;
  }
  static void remove(GLuint name) { glDeleteFramebuffers(1, &name); }
};
struct ShaderTraits {
  static GLuint make(GLenum stage) { return glCreateShader(stage); }
  static void remove(GLuint name) { glDeleteShader(name); }
};
struct ProgramTraits {
  static GLuint make() { return glCreateProgram(); }
  static void remove(GLuint name) { glDeleteProgram(name); }
};

using GlBuffer = GlHandle<BufferTraits>;
using GlVertexArray = GlHandle<VertexArrayTraits>;
using GlTexture = GlHandle<TextureTraits>;
using GlSampler = GlHandle<SamplerTraits>;
using GlRenderbuffer = GlHandle<RenderbufferTraits>;
using GlFramebuffer = GlHandle<FramebufferTraits>;
using GlShader = GlHandle<ShaderTraits>;
using GlProgram = GlHandle<ProgramTraits>;

}  // namespace tweend::render
