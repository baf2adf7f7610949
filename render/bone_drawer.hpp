#pragma once

#include <span>

#include "render/frame_memory.hpp"
#include "render/gl_handle.hpp"
#include "render/picture.hpp"
#include "render/shader_program.hpp"
#include "server/base/result.hpp"

namespace tweend::render {

/// Draws the joints and bones of skeletons, all of them at once. The context's thread only.
class BoneDrawer {
 public:
  /// @return Internal with the driver's log: the sources are ours
  [[nodiscard]] Status link();
  /// Draws them into what is bound; nothing where there are none.
  void draw(std::span<const BoneSource> bones, FrameMemory& memory) const;

 private:
  void upload_shapes();

  ShaderProgram program_;
  GlVertexArray vertex_array_ = GlVertexArray::make();
  GlBuffer shapes_ = GlBuffer::make();
  GLsizei vertex_count_ = 0;
};

}  // namespace tweend::render
