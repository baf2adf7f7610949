#include "server/animation/skin_vertices.hpp"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "server/animation/blend_kernels.hpp"

namespace tweend::animation {
namespace {

/// nullptr, or what is wrong.
const char* find_misuse(const SkinInfluences& influences, const VertexAttributes& in, const VertexTarget& out) {
  const std::size_t each = influences.per_vertex;
  if (each != 1 && each != 4 && each != 8) return "skin_vertices: takes 1, 4 or 8 influences a vertex";
  const std::size_t vertices = influences.entries.size() / each;
  if (influences.entries.size() != vertices * each || influences.weights.size() != influences.entries.size()) {
    return "skin_vertices: entries and weights differ in length";
  }
  const auto differs = [&](std::span<const float> source, std::span<float> target) {
    return !target.empty() && (target.size() != 3 * vertices || source.size() != target.size());
  };
  if (differs(in.positions, out.positions) || differs(in.normals, out.normals) || differs(in.tangents, out.tangents)) {
    return "skin_vertices: a stream's length is not that of the influences";
  }
  return nullptr;
}

glm::vec3 load(std::span<const float> stream, std::size_t vertex) {
  return {stream[3 * vertex], stream[3 * vertex + 1], stream[3 * vertex + 2]};
}

void store(std::span<float> stream, std::size_t vertex, const glm::vec3& value) {
  stream[3 * vertex] = value.x;
  stream[3 * vertex + 1] = value.y;
  stream[3 * vertex + 2] = value.z;
}

glm::vec3 unit_or(const glm::vec3& direction, const glm::vec3& fallback) {
  const float length = glm::length(direction);
  return length >= kShortestDirection ? direction / length : fallback;
}

Affine blended(const SkinInfluences& influences, std::span<const Affine> palette, std::size_t vertex) {
  Affine sum{{glm::vec4(0), glm::vec4(0), glm::vec4(0)}};
  for (std::size_t i = 0; i < influences.per_vertex; ++i) {
    const std::size_t at = vertex * influences.per_vertex + i;
    for (std::size_t r = 0; r < 3; ++r) sum.rows[r] += influences.weights[at] * palette[influences.entries[at]].rows[r];
  }
  return sum;
}

/// The inverse transpose but for its length: the cofactors, with the sign of the determinant.
glm::vec3 turned_normal(const Affine& matrix, const glm::vec3& normal) {
  const glm::vec3 a(matrix.rows[0]), b(matrix.rows[1]), c(matrix.rows[2]);
  const glm::vec3 ab = glm::cross(a, b);
  const glm::vec3 cofactors(glm::dot(glm::cross(b, c), normal), glm::dot(glm::cross(c, a), normal), glm::dot(ab, normal));
  return glm::dot(ab, c) < 0.0F ? -cofactors : cofactors;
}

}  // namespace

Status skin_vertices(const SkinInfluences& influences, std::span<const Affine> palette, const VertexAttributes& in,
                     const VertexTarget& out) noexcept {
  if (const char* misuse = find_misuse(influences, in, out)) return fail(ErrorCode::Internal, misuse);
  const std::size_t vertices = influences.entries.size() / influences.per_vertex;
  for (std::size_t v = 0; v < vertices; ++v) {
    const Affine m = blended(influences, palette, v);
    const auto along = [&](const glm::vec4& p) {
      return glm::vec3(glm::dot(m.rows[0], p), glm::dot(m.rows[1], p), glm::dot(m.rows[2], p));
    };
    if (!out.positions.empty()) store(out.positions, v, along({load(in.positions, v), 1.0F}));
    if (!out.normals.empty()) {
      const glm::vec3 normal = load(in.normals, v);
      store(out.normals, v, unit_or(turned_normal(m, normal), normal));
    }
    if (!out.tangents.empty()) {
      const glm::vec3 tangent = load(in.tangents, v);
      store(out.tangents, v, unit_or(along({tangent, 0.0F}), tangent));
    }
  }
  return {};
}

}  // namespace tweend::animation
