#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/frame_memory.hpp"
#include "render/gl_handle.hpp"
#include "render/picture.hpp"

namespace tweend::render {

/// Where shaders/deform.glsl finds what is new with a picture, in texels; its uniform `pose_at`.
struct PosePlace {
  GLint palette = 0;
  GLint targets = 0;
  GLint target_count = 0;
};

/// A mesh's skin and morph targets on the GPU, uploaded once. The context's thread only.
class GpuDeform {
 public:
  /// Morph targets that the device's largest buffer texture has no room for are left out, with a line in the log.
  explicit GpuDeform(const MeshSource& source);

  /// Whether an item is to be deformed on the GPU rather than drawn as its keyframes have it.
  [[nodiscard]] static bool wanted(const DrawItem& item) noexcept;
  /// Influences a vertex that the item's palette moves; 0 without one.
  [[nodiscard]] static std::size_t influences(const DrawItem& item) noexcept;

  /// Adds the skin to a vertex array: attributes 1, 2 (entries), 5, 6 (weights).
  void attach_to(GLuint vertex_array) const;
  /// Writes the item's palette and its targets of a weight other than 0 to the picture's memory, and binds what the shader
  /// reads them from.
  [[nodiscard]] PosePlace bind(const DrawItem& item, FrameMemory& memory) const;

  [[nodiscard]] bool empty() const noexcept { return per_vertex_ == 0 && runs_.empty(); }
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }

 private:
  /// A morph target as shaders/deform.glsl reads it, but for its weight.
  struct Run {
    std::int32_t first_vertex = 0;
    std::int32_t vertex_count = 0;
    std::int32_t positions = 0;  ///< texel of the first displacement
    std::int32_t normals = -1;   ///< the same; -1: none
  };
  void upload_skin(const SkinSource& skin);
  void upload_morphs(const std::vector<MorphSource>& morphs);

  std::size_t per_vertex_ = 0;
  GlBuffer entries_;
  GlBuffer weights_;
  std::vector<Run> runs_;
  GlBuffer displacements_;
  GlTexture displacement_texels_;
  std::size_t bytes_ = 0;
};

}  // namespace tweend::render
