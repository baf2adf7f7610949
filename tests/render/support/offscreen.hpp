#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "render/egl_context.hpp"
#include "render/readback.hpp"
#include "render/renderer.hpp"
#include "tests/render/support/image.hpp"

namespace tweend::render::test {

/// A context and a renderer on the test's own thread: draw, and look at the pixels.
class Offscreen {
 public:
  /// Throws, and so fails the test, where nothing draws.
  explicit Offscreen(std::size_t gpu_bytes = std::size_t{64} << 20U);

  [[nodiscard]] Renderer& renderer() { return *renderer_; }
  [[nodiscard]] Image draw(const Picture& picture, int samples = 1);

 private:
  std::unique_ptr<EglContext> context_;
  std::unique_ptr<Renderer> renderer_;
};

/// Where the mesh program puts an item's vertices: xyz each, model space.
struct Tweened {
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<float> tangents;  ///< only of a mesh with texture coordinates
};

/// Runs the item's vertices through the tween, the morphing and the skinning of render/shaders (tangents through the tween
/// only), bound by the real GpuMesh, and reads them back by transform feedback. The calling thread has a context.
[[nodiscard]] Tweened capture_tween(GpuCache& cache, const DrawItem& item);

/// What is in a buffer object, from an offset on.
[[nodiscard]] std::vector<float> read_buffer(GLuint name, GLintptr offset_bytes, std::size_t floats);

}  // namespace tweend::render::test
