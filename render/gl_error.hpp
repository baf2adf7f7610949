#pragma once

#include <epoxy/gl.h>

namespace tweend::render {

/// Takes the errors that GL has noted since they were last taken: they stay until somebody asks, and would be held against
/// whoever comes next. The context's thread only.
/// @return GL_NO_ERROR; GL_OUT_OF_MEMORY if that is among them, else the first
[[nodiscard]] inline GLenum take_gl_error() noexcept {
  constexpr int kMostFlags = 16;  // a context that is lost never runs out of errors
  GLenum found = GL_NO_ERROR;
  for (int i = 0; i < kMostFlags; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) break;
    if (found == GL_NO_ERROR || error == GL_OUT_OF_MEMORY) found = error;
  }
  return found;
}

}  // namespace tweend::render
