#pragma once

#include <cstddef>
#include <span>

#include "server/animation/vertex_attributes.hpp"
#include "server/base/result.hpp"

namespace tweend::animation {

/// out = Σ weights[i] · sources[i], vertex by vertex; blended normals and tangents are scaled to unit length.
///
/// A blended direction that is shorter than 1e-6 (opposite normals halfway) or not finite has no meaning: there that
/// of sources[nearest] is taken as it is. One source of weight 1 is copied, bit for bit.
/// Uses the widest vectors of the machine it runs on; results differ between machines in the last places, never
/// between two calls on one, nor with a vertex's place in the array. Success allocates nothing; safe from any thread.
///
/// @param sources  1 to 4, all with the streams that `out` asks for, of the same length
/// @param weights  one per source, finite
/// @param nearest  index into `sources`
/// @param out      may not overlap a source, unless there is only one, of weight 1
/// @return Internal when counts or lengths differ; `out` is then untouched
[[nodiscard]] Status blend_vertices(std::span<const VertexAttributes> sources, std::span<const float> weights,
                                    std::size_t nearest, const VertexTarget& out) noexcept;

}  // namespace tweend::animation
