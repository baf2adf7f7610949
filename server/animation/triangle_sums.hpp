#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>

namespace tweend::animation {

/// Vertex `index` of an xyz-interleaved stream, in double: the difference of two floats, and products of such, are then
/// exact or nearly so and never under- or overflow.
[[nodiscard]] inline glm::dvec3 vertex_at(std::span<const float> stream, std::size_t index) {
  const float* xyz = stream.data() + 3 * index;
  return {static_cast<double>(xyz[0]), static_cast<double>(xyz[1]), static_cast<double>(xyz[2])};
}

inline void store_vertex(std::span<float> stream, std::size_t index, const glm::dvec3& value) {
  float* xyz = stream.data() + 3 * index;
  xyz[0] = static_cast<float>(value.x);
  xyz[1] = static_cast<float>(value.y);
  xyz[2] = static_cast<float>(value.z);
}

/// The sums' directions are wanted, not their lengths, so all are scaled by one power of two that takes the largest
/// term to about 2^90. Floats hold 2^±126: a vertex may have 2^36 triangles, and a term 2^216 times smaller than the
/// largest still counts with full precision, without memory for sums in double.
inline constexpr int kLargestTermExponent = 90;

/// Writes to each vertex of `out` the sum of `term(a, b, c)` over the triangles (a, b, c) that it belongs to, times a
/// factor that all vertices share. Terms that are not finite are left out.
/// @param term  (index, index, index) → glm::dvec3; called twice a triangle
template <class Term>
void sum_over_triangles(std::span<const std::uint32_t> indices, std::span<float> out, const Term& term) {
  double largest = 0.0;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const glm::dvec3 t = term(indices[i], indices[i + 1], indices[i + 2]);
    const double length = std::abs(t.x) + std::abs(t.y) + std::abs(t.z);
    if (std::isfinite(length)) largest = std::max(largest, length);
  }
  std::ranges::fill(out, 0.0F);
  if (largest == 0.0) return;
  const int shift = kLargestTermExponent - std::ilogb(largest);
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const glm::dvec3 t = term(indices[i], indices[i + 1], indices[i + 2]);
    if (!std::isfinite(std::abs(t.x) + std::abs(t.y) + std::abs(t.z))) continue;
    const glm::dvec3 scaled{std::ldexp(t.x, shift), std::ldexp(t.y, shift), std::ldexp(t.z, shift)};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t vertex = indices[i + corner];
      store_vertex(out, vertex, vertex_at(out, vertex) + scaled);
    }
  }
}

/// `v` with length 1, or `fallback` where it has no length or is not finite.
[[nodiscard]] inline glm::dvec3 unit_or(const glm::dvec3& v, const glm::dvec3& fallback) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? v / length : fallback;
}

}  // namespace tweend::animation
