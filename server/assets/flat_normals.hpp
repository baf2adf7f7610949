#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tweend::assets {

/// Flat normals of a mesh, and which of its vertices had to be repeated for that.
struct FlatNormals {
  std::vector<float> normals;         ///< shape [(vertices + copies) × 3], unit length
  std::vector<std::uint32_t> copies;  ///< which vertex each further one repeats
};

/// Gives each triangle its own normal. A vertex keeps its place, with the normal of its first triangle; for each further
/// direction among its triangles a copy stands behind the others. Directions less than a thousandth apart are one: flat
/// surfaces keep their vertices. Vertices of no triangle, or of empty ones only, get +Y.
/// Pure; safe from any thread.
/// @param positions  shape [vertices × 3], finite
/// @param indices    shape [triangles × 3], each below the number of vertices (unchecked); those of copies are put in
[[nodiscard]] FlatNormals compute_flat_normals(std::span<const float> positions, std::span<std::uint32_t> indices);

}  // namespace tweend::assets
