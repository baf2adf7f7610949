#include "server/animation/vertex_tangents.hpp"

#include <glm/vec2.hpp>

#include "server/animation/triangle_sums.hpp"

namespace tweend::animation {
namespace {

/// A sum this much shorter along the surface than it is long points along the normal, but for rounding.
constexpr double kAlongNormal = 1e-6;

glm::dvec2 texcoord_at(std::span<const float> texcoords, std::size_t index) {
  return {static_cast<double>(texcoords[2 * index]), static_cast<double>(texcoords[2 * index + 1])};
}

/// ∂P/∂u of a triangle with edges e1, e2 in space and d1, d2 in the texture; zero where the texture's has no area.
glm::dvec3 along_u(const glm::dvec3& e1, const glm::dvec3& e2, const glm::dvec2& d1, const glm::dvec2& d2) {
  const double area = d1.x * d2.y - d2.x * d1.y;
  return area == 0.0 ? glm::dvec3(0.0) : (e1 * d2.y - e2 * d1.y) / area;
}

/// Some unit vector perpendicular to the unit vector n: from the axis that n is farthest from.
glm::dvec3 any_perpendicular(const glm::dvec3& n) {
  const glm::dvec3 a = glm::abs(n);
  const glm::dvec3 axis = a.x <= a.y && a.x <= a.z ? glm::dvec3(1, 0, 0)
                          : a.y <= a.z             ? glm::dvec3(0, 1, 0)
                                                   : glm::dvec3(0, 0, 1);
  return glm::normalize(axis - n * glm::dot(n, axis));
}

glm::dvec3 tangent_for(const glm::dvec3& normal, const glm::dvec3& sum) {
  const glm::dvec3 n = unit_or(normal, {0.0, 1.0, 0.0});
  const glm::dvec3 direction = unit_or(sum, n);
  const glm::dvec3 in_surface = direction - n * glm::dot(n, direction);
  if (glm::length(in_surface) <= kAlongNormal) return any_perpendicular(n);
  return glm::normalize(in_surface);
}

}  // namespace

Status compute_tangents(std::span<const float> positions, std::span<const float> normals, std::span<const float> texcoords,
                        std::span<const std::uint32_t> indices, std::span<float> out_tangents) noexcept {
  if (positions.size() % 3 != 0) return fail(ErrorCode::Internal, "compute_tangents: positions are not triples");
  if (indices.size() % 3 != 0) return fail(ErrorCode::Internal, "compute_tangents: indices are not triples");
  const std::size_t vertex_count = positions.size() / 3;
  if (normals.size() != positions.size() || texcoords.size() != 2 * vertex_count || out_tangents.size() != positions.size()) {
    return fail(ErrorCode::Internal, "compute_tangents: lengths differ");
  }
  sum_over_triangles(indices, out_tangents, [&](std::size_t a, std::size_t b, std::size_t c) {
    const glm::dvec3 corner = vertex_at(positions, a);
    const glm::dvec2 texture_corner = texcoord_at(texcoords, a);
    return along_u(vertex_at(positions, b) - corner, vertex_at(positions, c) - corner,
                   texcoord_at(texcoords, b) - texture_corner, texcoord_at(texcoords, c) - texture_corner);
  });
  for (std::size_t v = 0; v < vertex_count; ++v) {
    store_vertex(out_tangents, v, tangent_for(vertex_at(normals, v), vertex_at(out_tangents, v)));
  }
  return {};
}

}  // namespace tweend::animation
