#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>

#include "render/bone_drawer.hpp"
#include "render/frame_memory.hpp"
#include "render/gl_handle.hpp"
#include "render/gpu_cache.hpp"
#include "render/mesh_programs.hpp"
#include "render/picture.hpp"
#include "render/render_target.hpp"
#include "render/shader_program.hpp"
#include "server/base/result.hpp"

namespace tweend::render {

/// Draws pictures with OpenGL 4.5 core: keyframes are tweened, or one is morphed and skinned, by the vertex shader; light is
/// Blinn-Phong in linear light.
/// The context's thread only.
class Renderer {
 public:
  /// @param gpu_bytes  what meshes and keyframes may take of the GPU's memory
  /// @return Internal with the driver's log where a shader of ours does not compile
  [[nodiscard]] static Result<std::unique_ptr<Renderer>> make(std::size_t gpu_bytes);

  /// Draws the picture; the GPU may still be at it when this returns. The picture may go then.
  void draw(const Picture& picture, const RenderTarget& target);

  [[nodiscard]] GpuCache& cache() noexcept { return cache_; }
  [[nodiscard]] const FrameMemory& memory() const noexcept { return memory_; }

 private:
  explicit Renderer(std::size_t gpu_bytes) : cache_(gpu_bytes) {}
  [[nodiscard]] Status link_programs();
  void make_samplers();
  void set_frame(const Picture& picture);
  void draw_item(const DrawItem& item);
  void draw_grid(const Picture& picture) const;

  GpuCache cache_;
  FrameMemory memory_;
  MeshPrograms mesh_programs_;
  BoneDrawer bone_drawer_;
  std::array<GlSampler, 9> samplers_;  ///< three ways to wrap u, for each of which three to wrap v
  ShaderProgram grid_program_;
  GLint grid_center_ = -1;
  GlBuffer frame_ = GlBuffer::make();
  GlVertexArray no_vertices_ = GlVertexArray::make();
};

}  // namespace tweend::render
