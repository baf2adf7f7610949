#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/base/result.hpp"
#include "server/model/content_hash.hpp"

namespace tweend::model {

/// A picture in memory: 8 bits a channel, red green blue alpha, sRGB, straight alpha, top row first, rows without gaps.
/// Immutable once made; shared by every material and revision that shows it.
class Image {
 public:
  /// @param rgba  shape [height × width × 4]
  /// @return InvalidParams where the bytes do not fit the size, or a side is 0
  [[nodiscard]] static Result<std::shared_ptr<const Image>> make(std::uint32_t width, std::uint32_t height,
                                                                 std::vector<std::uint8_t> rgba);

  [[nodiscard]] std::uint32_t width() const noexcept { return width_; }
  [[nodiscard]] std::uint32_t height() const noexcept { return height_; }
  [[nodiscard]] const std::vector<std::uint8_t>& rgba() const noexcept { return rgba_; }
  [[nodiscard]] const ContentHash& hash() const noexcept { return hash_; }

 private:
  Image() = default;
  std::uint32_t width_ = 0;
  std::uint32_t height_ = 0;
  std::vector<std::uint8_t> rgba_;
  ContentHash hash_;
};

using ImagePtr = std::shared_ptr<const Image>;

/// The colour of a mesh that says nothing of its own: the technique's first publication shaded its model so.
inline constexpr glm::vec3 kDefaultBaseColor{0.5F, 0.5F, 1.0F};

/// What a texture shows beyond its edges (glTF's `wrapS` and `wrapT`).
enum class TextureWrap : std::uint8_t { Repeat, MirroredRepeat, ClampToEdge };

/// How a part of a mesh reflects light.
struct Material {
  std::string name;                         ///< as the file calls it
  glm::vec3 base_color{kDefaultBaseColor};  ///< sRGB, 0 to 1; multiplies the texture (in linear light)
  ImagePtr base_color_texture;              ///< may be null
  TextureWrap wrap_u = TextureWrap::Repeat;
  TextureWrap wrap_v = TextureWrap::Repeat;
  float alpha = 1.0F;                   ///< multiplies the texture's
  std::optional<float> alpha_cutoff{};  ///< what is more transparent is not drawn; empty: all is, opaque
  bool unlit = false;                   ///< shows its colour as it is
};

/// A run of a mesh's triangles that show one material.
struct MeshPart {
  std::uint32_t first_index = 0;  ///< a multiple of 3
  std::uint32_t index_count = 0;  ///< a multiple of 3, at least 3
  std::uint32_t material = 0;     ///< which of the mesh's materials
  bool operator==(const MeshPart&) const = default;
};

/// What a mesh looks like, beside its shape.
struct Surface {
  std::vector<Material> materials;  ///< empty: one default material for all
  std::vector<MeshPart> parts;      ///< all triangles, each once, in order; empty where there is no material
};

}  // namespace tweend::model
