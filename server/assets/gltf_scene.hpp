#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/assets/gltf_file.hpp"
#include "server/assets/gltf_warnings.hpp"
#include "server/base/limits.hpp"
#include "server/base/result.hpp"
#include "server/model/skeleton.hpp"

namespace tweend::assets {

/// The nodes of a file's default scene, which are the joints of the actor: depth first, children in their order.
struct GltfScene {
  std::vector<JsonNode> nodes;       ///< shape [joints]
  std::vector<model::Joint> joints;  ///< shape [joints]; parents stand before their children
  /// shape [nodes of the file]; nothing: not in the scene
  std::vector<std::optional<std::uint32_t>> joint_of_node;
};

/// Reads the default scene: `scene`, else the first one, else all nodes without a parent.
/// @return BadAsset for no nodes, for a node with two parents or above itself, or for a transform that is none; Limit for more
///         than Limits::joints_per_actor
[[nodiscard]] Result<GltfScene> read_gltf_scene(const GltfFile& file, const Limits& limits, GltfWarnings& warnings);

}  // namespace tweend::assets
