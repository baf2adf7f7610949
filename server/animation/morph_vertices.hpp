#pragma once

#include <cstddef>
#include <span>

#include "server/animation/vertex_attributes.hpp"

namespace tweend::animation {

/// Displacements of a run of vertices at weight 1, borrowed; each stream is empty or shape [vertex_count × 3].
struct MorphTargetView {
  std::size_t first_vertex = 0;
  std::size_t vertex_count = 0;
  VertexAttributes displacements;  ///< not unit vectors
};

/// vertices += Σ weights[i] · targets[i], each over its run of vertices; then normals and tangents of the vertices touched are
/// scaled to unit length, where there is one, and otherwise stay as they were. Targets of weight 0 cost nothing.
/// Pure; allocates nothing.
/// @param targets   shape [weights]
/// @param vertices  what the base mesh is; streams that are empty are not computed
/// Precondition: runs lie within the vertices.
void morph_vertices(std::span<const MorphTargetView> targets, std::span<const float> weights,
                    const VertexTarget& vertices) noexcept;

}  // namespace tweend::animation
