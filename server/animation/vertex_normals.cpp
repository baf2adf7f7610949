#include "server/animation/vertex_normals.hpp"

#include "server/animation/triangle_sums.hpp"

namespace tweend::animation {

Status compute_normals(std::span<const float> positions, std::span<const std::uint32_t> indices,
                       std::span<float> out_normals) noexcept {
  if (positions.size() % 3 != 0) return fail(ErrorCode::Internal, "compute_normals: positions are not triples");
  if (indices.size() % 3 != 0) return fail(ErrorCode::Internal, "compute_normals: indices are not triples");
  if (out_normals.size() != positions.size()) return fail(ErrorCode::Internal, "compute_normals: output length differs");
  sum_over_triangles(indices, out_normals, [&](std::size_t a, std::size_t b, std::size_t c) {
    const glm::dvec3 corner = vertex_at(positions, a);
    return glm::cross(vertex_at(positions, b) - corner, vertex_at(positions, c) - corner);
  });
  for (std::size_t v = 0; v < out_normals.size() / 3; ++v) {
    store_vertex(out_normals, v, unit_or(vertex_at(out_normals, v), {0.0, 1.0, 0.0}));
  }
  return {};
}

}  // namespace tweend::animation
