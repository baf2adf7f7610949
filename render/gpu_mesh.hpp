#pragma once

#include <cstddef>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "render/frame_memory.hpp"
#include "render/gl_handle.hpp"
#include "render/gpu_deform.hpp"
#include "render/key_buffer.hpp"
#include "render/picture.hpp"

namespace tweend::render {

/// The vertex colour of shaders/mesh.vert. A mesh without colours takes the context's current value of it.
inline constexpr GLuint kColorAttribute = 13;

/// A mesh on the GPU: indices, texture coordinates, colours, skin and morph targets, the keyframes' buffer, and what binds them
/// together. The context's thread only.
class GpuMesh {
 public:
  /// Triangles that are drawn at once.
  struct Range {
    std::size_t first_index = 0;
    GLsizei index_count = 0;
    glm::vec4 base_color{1.0F};  ///< linear, and alpha
    std::shared_ptr<const GlTexture> texture;
    TextureWrap wrap_u = TextureWrap::Repeat;
    TextureWrap wrap_v = TextureWrap::Repeat;
    std::optional<float> alpha_cutoff;
    bool unlit = false;
  };
  using Textures = std::vector<std::shared_ptr<const GlTexture>>;

  /// @param textures      shape [materials]; null where a material has none
  /// @param most_key_bytes  of all keyframes together
  GpuMesh(const MeshSource& source, const Textures& textures, std::size_t most_key_bytes);

  /// Binds the vertex array with the item's vertices, be they keyframes' or the moment's, and what deforms them; ready to draw
  /// the ranges.
  PosePlace bind(const DrawItem& item, FrameMemory& memory);
  [[nodiscard]] const std::vector<Range>& ranges() const noexcept { return ranges_; }
  [[nodiscard]] std::size_t bytes() const noexcept { return fixed_bytes_ + keys_.bytes() + deform_.bytes(); }
  [[nodiscard]] const KeyBuffer& keys() const noexcept { return keys_; }

 private:
  void upload_indices(const MeshSource& source, const Textures& textures);
  void upload_fixed(const MeshSource& source);
  void set_up(GLuint vertex_array, GLuint sources) const;
  void bind_source(GLuint vertex_array, GLuint source, GLuint buffer, GLintptr offset) const;

  GlVertexArray tweened_ = GlVertexArray::make();
  GlVertexArray posed_;  ///< one keyframe and the skin; where the mesh has none of that, none
  GlBuffer indices_ = GlBuffer::make();
  GlBuffer texcoords_;
  GlBuffer colors_;
  GpuDeform deform_;
  KeyBuffer keys_;
  std::vector<Range> ranges_;
  std::size_t fixed_bytes_ = 0;
  GLintptr stream_bytes_ = 0;  ///< of one keyframe's positions, or normals, or tangents
  bool tangents_ = false;
};

/// sRGB's transfer function (IEC 61966-2-1), from 0 to 1 each way.
[[nodiscard]] glm::vec3 linear_from_srgb(const glm::vec3& srgb) noexcept;

}  // namespace tweend::render
