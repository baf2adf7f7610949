#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "server/assets/gltf_accessors.hpp"
#include "server/assets/gltf_materials.hpp"
#include "server/assets/gltf_warnings.hpp"
#include "server/base/limits.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

/// Displacements of a primitive's vertices by one morph target; each shape [vertices × 3] or empty.
struct GltfTarget {
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<float> tangents;
};

/// One primitive of a mesh, as triangles. Vertices stand in the order of its accessors.
struct GltfPrimitive {
  std::vector<float> positions;        ///< shape [vertices × 3]
  std::vector<float> normals;          ///< shape [vertices × 3]
  std::vector<float> texcoords;        ///< shape [vertices × 2], v upwards; empty: none
  std::vector<float> colors;           ///< shape [vertices × 4], linear; empty: none
  std::vector<std::uint16_t> joints;   ///< shape [vertices × influences], of a skin; empty: none
  std::vector<float> weights;          ///< the same shape
  std::size_t influences = 0;          ///< 0, 4 or 8
  std::vector<std::uint32_t> indices;  ///< shape [triangles × 3]
  std::vector<GltfTarget> targets;
  std::uint32_t material = 0;

  [[nodiscard]] std::size_t vertex_count() const noexcept { return positions.size() / 3; }
};

/// What may still be taken in before an actor is too large.
struct GltfRoom {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::size_t morphed_vertices = 0;
};

/// Reads primitives. Not thread-safe.
class GltfPrimitives {
 public:
  /// All outlive this.
  GltfPrimitives(const GltfFile& file, GltfAccessors& accessors, GltfMaterials& materials, GltfWarnings& warnings);

  /// @param room  is lessened by what was read
  /// @return nothing for points and lines, with a warning; BadAsset; Limit where there is not enough room
  [[nodiscard]] Result<std::optional<GltfPrimitive>> read(const JsonNode& node, GltfRoom& room);

 private:
  [[nodiscard]] Status read_shape(const JsonNode& node, std::size_t mode, GltfRoom& room, GltfPrimitive& out);
  [[nodiscard]] Status read_indices(const JsonNode& node, std::size_t mode, GltfRoom& room, GltfPrimitive& out);
  [[nodiscard]] Status read_texcoords(const JsonNode& attributes, const GltfMaterial& material, GltfPrimitive& out);
  [[nodiscard]] Status read_colors(const JsonNode& attributes, GltfPrimitive& out);
  [[nodiscard]] Status read_influences(const JsonNode& attributes, GltfPrimitive& out);
  [[nodiscard]] Status read_targets(const JsonNode& node, GltfRoom& room, GltfPrimitive& out);
  /// The floats of an attribute with as many elements as there are vertices; empty where there is none of that name.
  [[nodiscard]] Result<std::vector<float>> attribute(const JsonNode& attributes, std::string_view name, std::size_t vertices,
                                                     const GltfAccessorRule& rule);

  GltfAccessors& accessors_;
  GltfMaterials& materials_;
  GltfWarnings& warnings_;
  bool quantized_;  ///< whether the file uses KHR_mesh_quantization
};

}  // namespace tweend::assets
