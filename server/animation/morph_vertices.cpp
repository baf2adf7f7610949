#include "server/animation/morph_vertices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "server/animation/blend_kernels.hpp"

namespace tweend::animation {
namespace {

/// Vertices made at a time: their sums stay in the first-level cache whatever the number of targets.
constexpr std::size_t kPiece = 256;
using PieceFloats = std::array<float, 3 * kPiece>;

struct Targets {
  std::span<const MorphTargetView> views;
  std::span<const float> weights;
};

bool covers(const MorphTargetView& target, std::size_t vertex) {
  return vertex >= target.first_vertex && vertex < target.first_vertex + target.vertex_count;
}

/// Where the targets that cover `first` are no longer the same, or the piece is full, or the vertices end.
std::size_t end_of_piece(const Targets& targets, std::size_t first, std::size_t vertex_count) {
  std::size_t end = std::min(first + kPiece, vertex_count);
  for (std::size_t i = 0; i < targets.views.size(); ++i) {
    if (targets.weights[i] == 0.0F) continue;
    const std::size_t run_end = targets.views[i].first_vertex + targets.views[i].vertex_count;
    if (targets.views[i].first_vertex > first) end = std::min(end, targets.views[i].first_vertex);
    if (run_end > first) end = std::min(end, run_end);
  }
  return end;
}

/// base + Σ weight · displacement of the vertices [first, end), three displacements a pass.
/// @return whether there was any
bool add_displacements(const Targets& targets, std::span<const float> VertexAttributes::*stream, std::size_t first,
                       std::span<const float> base, PieceFloats& sum) {
  PieceFloats passed;
  StreamBlend blend{.source = {base.data()}, .weight = {1.0F}, .source_count = 1, .out = sum.data(), .size = base.size()};
  bool any = false;
  for (std::size_t i = 0; i < targets.views.size(); ++i) {
    const MorphTargetView& target = targets.views[i];
    const std::span<const float> displacements = target.displacements.*stream;
    if (targets.weights[i] == 0.0F || displacements.empty() || !covers(target, first)) continue;
    if (blend.source_count == 4) {
      blend_values(blend);
      std::copy_n(sum.data(), base.size(), passed.data());
      blend.source[0] = passed.data();
      blend.source_count = 1;
    }
    blend.source[blend.source_count] = displacements.data() + 3 * (first - target.first_vertex);
    blend.weight[blend.source_count++] = targets.weights[i];
    any = true;
  }
  if (any) blend_values(blend);
  return any;
}

void morph_piece(const Targets& targets, std::span<const float> VertexAttributes::*source, std::span<float> stream,
                 bool is_direction, std::size_t first, std::size_t end) {
  if (stream.empty()) return;
  const std::span<float> piece = stream.subspan(3 * first, 3 * (end - first));
  PieceFloats sum;
  if (!add_displacements(targets, source, first, piece, sum)) return;
  if (!is_direction) {
    std::copy_n(sum.data(), piece.size(), piece.data());
    return;
  }
  PieceFloats base;
  std::ranges::copy(piece, base.begin());
  blend_directions({.source = {sum.data(), base.data()},
                    .weight = {1.0F, 0.0F},
                    .source_count = 2,
                    .nearest = 1,
                    .out = piece.data(),
                    .size = piece.size()});
}

}  // namespace

void morph_vertices(std::span<const MorphTargetView> targets, std::span<const float> weights,
                    const VertexTarget& vertices) noexcept {
  const Targets all{targets, weights};
  const std::size_t floats = std::max({vertices.positions.size(), vertices.normals.size(), vertices.tangents.size()});
  for (std::size_t first = 0, end = 0; first < floats / 3; first = end) {
    end = end_of_piece(all, first, floats / 3);
    morph_piece(all, &VertexAttributes::positions, vertices.positions, false, first, end);
    morph_piece(all, &VertexAttributes::normals, vertices.normals, true, first, end);
    morph_piece(all, &VertexAttributes::tangents, vertices.tangents, true, first, end);
  }
}

}  // namespace tweend::animation
