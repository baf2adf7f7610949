#pragma once

#include <cstdint>
#include <span>

#include "server/base/result.hpp"

namespace tweend::animation {

/// Vertex normals weighted by area: the sum of the cross products of each vertex's triangles, scaled to unit length.
/// Vertices of no triangle, or of empty ones only, get +Y.
/// Coordinates may be as large or small as floats are. Allocates nothing on success; safe from any thread.
/// @param positions    shape [vertex_count × 3], finite, any unit
/// @param indices      shape [triangle_count × 3], counter-clockwise seen from outside, each below vertex_count (unchecked)
/// @param out_normals  the shape of `positions`; may not overlap it
/// @return Internal when lengths differ or are no multiple of 3; `out_normals` is then untouched
[[nodiscard]] Status compute_normals(std::span<const float> positions, std::span<const std::uint32_t> indices,
                                     std::span<float> out_normals) noexcept;

}  // namespace tweend::animation
