#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/assets/gltf_accessors.hpp"
#include "server/assets/gltf_primitive.hpp"
#include "server/assets/gltf_progress.hpp"
#include "server/assets/gltf_scene.hpp"
#include "server/model/model.hpp"

namespace tweend::assets {

/// The morph weights of a node, among those of the actor.
struct GltfWeights {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// What the meshes of a scene come to: one mesh, with a skin that moves it and its morph targets; all null where the scene has
/// no triangles.
struct GltfMesh {
  model::MeshPtr mesh;
  model::VertexKeyPtr rest;
  model::SkinPtr skin;
  model::MorphTargetsPtr morphs;
  /// shape [nodes of the file]; nothing: no weights of its own that show anywhere
  std::vector<std::optional<GltfWeights>> weights_of_node;
};

/// Puts the meshes of all the scene's nodes behind each other, in the order of their joints. A node's mesh without a skin
/// follows that node alone; one with a skin follows the skin's joints, and its node's own transform is ignored.
/// @return BadAsset; Limit
[[nodiscard]] Result<GltfMesh> read_gltf_mesh(const GltfFile& file, const GltfScene& scene, GltfAccessors& accessors,
                                              GltfPrimitives& primitives, GltfMaterials& materials, const Limits& limits,
                                              GltfProgress& progress);

}  // namespace tweend::assets
