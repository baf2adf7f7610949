#pragma once

#include <cstdint>
#include <span>

#include "server/base/result.hpp"

namespace tweend::animation {

/// Unit tangents along growing u: per triangle ∂P/∂u, summed per vertex, made perpendicular to the normal by
/// Gram-Schmidt (E. Lengyel, Foundations of Game Engine Development 2, section 7.5). Where that gives none (no triangle,
/// texture coordinates without area, along the normal) the tangent is some unit vector perpendicular to the normal.
/// Coordinates may be as large or small as floats are. Allocates nothing on success; safe from any thread.
/// @param positions     shape [vertex_count × 3], finite, model space
/// @param normals       the same shape, unit
/// @param texcoords     shape [vertex_count × 2], finite
/// @param indices       shape [triangle_count × 3], each below vertex_count (unchecked)
/// @param out_tangents  the shape of `positions`; may overlap none of the others
/// @return Internal when lengths do not fit together; `out_tangents` is then untouched
[[nodiscard]] Status compute_tangents(std::span<const float> positions, std::span<const float> normals,
                                      std::span<const float> texcoords, std::span<const std::uint32_t> indices,
                                      std::span<float> out_tangents) noexcept;

}  // namespace tweend::animation
