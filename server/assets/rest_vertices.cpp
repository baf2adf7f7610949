#include "server/assets/rest_vertices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <span>

#include "server/model/evaluate.hpp"

namespace tweend::assets {
namespace {

struct Placing {
  glm::dmat3 turn;
  glm::dvec3 move;
};

/// How the joints at rest move a vertex.
Placing placing_of(const model::Skin& skin, std::span<const animation::Affine> matrices, std::size_t vertex) {
  const animation::SkinInfluences influences = skin.influences();
  Placing sum{glm::dmat3(0.0), glm::dvec3(0.0)};
  for (std::size_t i = vertex * influences.per_vertex; i < (vertex + 1) * influences.per_vertex; ++i) {
    const animation::Affine& m = matrices[influences.entries[i]];
    for (int r = 0; r < 3; ++r) {
      const glm::dvec4 row = glm::dvec4(m.rows[static_cast<std::size_t>(r)]) * double{influences.weights[i]};
      for (int c = 0; c < 3; ++c) sum.turn[c][r] += row[c];
      sum.move[r] += row.w;
    }
  }
  return sum;
}

glm::dvec3 load(std::span<const float> values, std::size_t vertex) {
  return {values[3 * vertex], values[3 * vertex + 1], values[3 * vertex + 2]};
}

void append(const glm::dvec3& v, std::vector<float>& out) {
  for (int c = 0; c < 3; ++c) out.push_back(static_cast<float>(v[c]));
}

}  // namespace

std::optional<std::size_t> rigid_joint(const model::Model& model) noexcept {
  if (!model.skin || model.skin->entries().size() != 1) return std::nullopt;
  const model::SkinEntry& entry = model.skin->entries().front();
  if (entry.joint_from_mesh != animation::Affine()) return std::nullopt;
  return entry.joint;
}

RestPose::RestPose(const model::Actor& actor) : actor_(actor) {
  if (!actor.model->skin) return;
  model::Evaluator evaluator;
  const auto matrices = evaluator.skin_matrices(actor, model::shown_clip(std::make_shared<const model::Clip>(), 0.0));
  const bool moves = std::ranges::any_of(matrices, [](const animation::Affine& m) { return m != animation::Affine(); });
  if (moves) matrices_.assign(matrices.begin(), matrices.end());
}

Result<RestVertices> RestPose::unskinned(const model::VertexKey& key) const {
  constexpr double kFlattest = 1e-12;  // of a volume, relative
  const std::span<const float> positions = key.positions(), normals = key.normals();
  if (matrices_.empty()) return RestVertices{{positions.begin(), positions.end()}, {normals.begin(), normals.end()}};
  RestVertices vertices;
  vertices.positions.reserve(positions.size());
  vertices.normals.reserve(normals.size());
  for (std::size_t v = 0; v < key.vertex_count(); ++v) {
    const Placing placing = placing_of(*actor_.model->skin, matrices_, v);
    const double reach = glm::length(placing.turn[0]) * glm::length(placing.turn[1]) * glm::length(placing.turn[2]);
    if (!(std::abs(glm::determinant(placing.turn)) > kFlattest * reach)) {
      return fail(
          ErrorCode::InvalidParams,
          fmt::format("expected joints that keep the size of the mesh at rest, so that clips of vertices can be told as "
                      "displacements; found that those of \"{}\" flatten vertex {}: remove its clips of vertices, or "
                      "export them as obj_sequence",
                      actor_.name, v),
          "params.actor");
    }
    append(glm::inverse(placing.turn) * (load(positions, v) - placing.move), vertices.positions);
    // Normals are turned by the inverse transpose, of which the transpose is the inverse; skinning keeps their side.
    append(glm::transpose(placing.turn) * load(normals, v), vertices.normals);
  }
  return vertices;
}

}  // namespace tweend::assets
