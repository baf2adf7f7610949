#include "server/animation/skin_vertices.hpp"

#include "server/animation/skin_kernels.hpp"

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

}  // namespace

Status skin_vertices(const SkinInfluences& influences, std::span<const Affine> palette, const VertexAttributes& in,
                     const VertexTarget& out) noexcept {
  if (const char* misuse = find_misuse(influences, in, out)) return fail(ErrorCode::Internal, misuse);
  skin_checked_vertices(influences, palette, in, out);
  return {};
}

}  // namespace tweend::animation
