#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "server/animation/affine.hpp"
#include "server/animation/vertex_attributes.hpp"
#include "server/base/result.hpp"

namespace tweend::animation {

/// Which matrices move each vertex, and how much, borrowed.
struct SkinInfluences {
  std::size_t per_vertex = 0;              ///< 1, 4 or 8
  std::span<const std::uint16_t> entries;  ///< shape [vertex_count × per_vertex], indices into the palette
  std::span<const float> weights;          ///< the same shape, >= 0, sum 1 a vertex; one influence: all 1
};

/// Linear blend skinning: position = Σ w · M · p, normals and tangents by the same blended matrix's inverse transpose
/// (for tangents the matrix itself), scaled to unit length; where that leaves nothing, as they were.
/// A matrix that flattens space turns normals across the plane that is left; one that mirrors keeps them outside.
/// Pure; success allocates nothing; safe from any thread.
/// @param palette  model_from_joint · inverse bind matrix for each entry
/// @param out      may not overlap `in`
/// @return Internal when lengths differ; `out` is then untouched
[[nodiscard]] Status skin_vertices(const SkinInfluences& influences, std::span<const Affine> palette,
                                   const VertexAttributes& in, const VertexTarget& out) noexcept;

}  // namespace tweend::animation
