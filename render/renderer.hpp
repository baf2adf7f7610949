#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>

#include "render/gl_handle.hpp"
#include "render/gpu_cache.hpp"
#include "render/picture.hpp"
#include "render/render_target.hpp"
#include "render/shader_program.hpp"
#include "server/base/result.hpp"

namespace tweend::render {

/// Draws pictures with OpenGL 4.5 core: keyframes are tweened by the vertex shader, light is Blinn-Phong in linear light.
/// The context's thread only.
class Renderer {
 public:
  /// @param gpu_bytes  what meshes and keyframes may take of the GPU's memory
  /// @return Internal with the driver's log where a shader of ours does not compile
  [[nodiscard]] static Result<std::unique_ptr<Renderer>> make(std::size_t gpu_bytes);

  /// Draws the picture; the GPU may still be at it when this returns. The picture may go then.
  void draw(const Picture& picture, const RenderTarget& target);

  [[nodiscard]] GpuCache& cache() noexcept { return cache_; }

 private:
  /// The mesh program for so many bound keyframes, and where its uniforms are.
  struct MeshProgram {
    ShaderProgram program;
    GLint world_from_model = -1;
    GLint world_from_model_normal = -1;
    GLint weights = -1;
    GLint nearest = -1;
    GLint base_color = -1;
    GLint textured = -1;
  };

  explicit Renderer(std::size_t gpu_bytes) : cache_(gpu_bytes) {}
  [[nodiscard]] Status link_programs();
  void set_frame(const Picture& picture);
  void draw_item(const DrawItem& item);
  void draw_grid(const Picture& picture) const;

  GpuCache cache_;
  std::array<MeshProgram, 3> mesh_programs_;  ///< for 1, 2 and up to 4 keyframes
  ShaderProgram grid_program_;
  GLint grid_center_ = -1;
  GlBuffer frame_ = GlBuffer::make();
  GlVertexArray no_vertices_ = GlVertexArray::make();
};

}  // namespace tweend::render
