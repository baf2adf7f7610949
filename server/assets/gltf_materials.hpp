#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/assets/gltf_buffers.hpp"
#include "server/assets/gltf_file.hpp"
#include "server/assets/gltf_uri.hpp"
#include "server/assets/gltf_warnings.hpp"
#include "server/base/limits.hpp"
#include "server/base/result.hpp"
#include "server/model/material.hpp"

namespace tweend::assets {

/// A material, and how its primitives' texture coordinates become those of its texture.
struct GltfMaterial {
  std::uint32_t number = 0;               ///< in GltfMaterials::take()
  std::optional<std::size_t> texcoord{};  ///< which TEXCOORD_n; nothing: there is no texture
  glm::dmat3 uv_from_texcoord{1.0};       ///< KHR_texture_transform
};

/// The materials that a file's primitives show, each read once. Not thread-safe.
class GltfMaterials {
 public:
  /// @param file, uris, buffers, limits, warnings  outlive this
  GltfMaterials(const GltfFile& file, GltfUris& uris, GltfBuffers& buffers, const Limits& limits, GltfWarnings& warnings)
      : file_(file), uris_(uris), buffers_(buffers), limits_(limits), warnings_(warnings) {}

  /// The material of a primitive; one that names none shows glTF's default, white.
  /// @return BadAsset; Limit for a texture of more than Limits::texture_pixels, or 16 times as many together
  [[nodiscard]] Result<GltfMaterial> of_primitive(const JsonNode& primitive);

  /// All that were asked for, in order of first use.
  [[nodiscard]] std::vector<model::Material> take() { return std::move(materials_); }

 private:
  [[nodiscard]] Result<GltfMaterial> read(const JsonNode& node);
  [[nodiscard]] Status read_color(const JsonNode& pbr, GltfMaterial& how, model::Material& material);
  [[nodiscard]] Status read_alpha(const JsonNode& node, model::Material& material);
  [[nodiscard]] Status read_texture_info(const JsonNode& info, GltfMaterial& how, model::Material& material);
  [[nodiscard]] Status read_sampler(const JsonNode& texture, model::Material& material) const;
  [[nodiscard]] Result<model::ImagePtr> image(const JsonNode& reference);

  const GltfFile& file_;
  GltfUris& uris_;
  GltfBuffers& buffers_;
  const Limits& limits_;
  GltfWarnings& warnings_;
  std::vector<model::Material> materials_;
  std::map<std::size_t, GltfMaterial> known_;  ///< by index in the file; that of none stands behind the last
  std::map<std::size_t, model::ImagePtr> images_;
  std::uint64_t pixels_ = 0;  ///< of all images_
};

}  // namespace tweend::assets
