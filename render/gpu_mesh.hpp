#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "render/gl_handle.hpp"
#include "render/key_buffer.hpp"
#include "render/picture.hpp"

namespace tweend::render {

/// A mesh on the GPU: indices, texture coordinates, the keyframes' buffer, and what binds them together.
/// The context's thread only.
class GpuMesh {
 public:
  /// Triangles that are drawn at once.
  struct Range {
    std::size_t first_index = 0;
    GLsizei index_count = 0;
    glm::vec3 base_color{1.0F};  ///< linear
    std::shared_ptr<const GlTexture> texture;
  };
  using Textures = std::vector<std::shared_ptr<const GlTexture>>;

  /// @param textures      shape [materials]; null where a material has none
  /// @param most_key_bytes  of all keyframes together
  GpuMesh(const MeshSource& source, const Textures& textures, std::size_t most_key_bytes);

  /// Binds the vertex array with the item's keyframes as its attributes; ready to draw the ranges.
  void bind(const DrawItem& item);
  [[nodiscard]] const std::vector<Range>& ranges() const noexcept { return ranges_; }
  [[nodiscard]] std::size_t bytes() const noexcept { return fixed_bytes_ + keys_.bytes(); }
  [[nodiscard]] const KeyBuffer& keys() const noexcept { return keys_; }

 private:
  void upload_indices(const MeshSource& source, const Textures& textures);

  GlVertexArray vertex_array_ = GlVertexArray::make();
  GlBuffer indices_ = GlBuffer::make();
  GlBuffer texcoords_;
  KeyBuffer keys_;
  std::vector<Range> ranges_;
  std::size_t fixed_bytes_ = 0;
  GLintptr stream_bytes_ = 0;  ///< of one keyframe's positions, or normals, or tangents
  bool tangents_ = false;
};

/// sRGB's transfer function (IEC 61966-2-1), from 0 to 1 each way.
[[nodiscard]] glm::vec3 linear_from_srgb(const glm::vec3& srgb) noexcept;

}  // namespace tweend::render
