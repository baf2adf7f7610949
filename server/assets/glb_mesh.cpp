#include "server/assets/glb_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "server/assets/glb_influences.hpp"
#include "server/assets/glb_materials.hpp"

namespace tweend::assets {
namespace {

/// A part of the mesh with the vertices it needs.
struct Piece {
  std::vector<std::uint32_t> vertices;  ///< of the mesh, ascending
  std::vector<std::uint32_t> indices;   ///< into `vertices`
  std::size_t material = 0;
};

Piece piece_of(const model::Mesh& mesh, const model::MeshPart& part, bool whole) {
  const auto indices = mesh.indices().subspan(part.first_index, part.index_count);
  Piece piece{{}, {indices.begin(), indices.end()}, part.material};
  if (whole) {
    piece.vertices.resize(mesh.vertex_count());
    std::iota(piece.vertices.begin(), piece.vertices.end(), 0U);
    return piece;
  }
  piece.vertices = piece.indices;
  std::ranges::sort(piece.vertices);
  piece.vertices.erase(std::unique(piece.vertices.begin(), piece.vertices.end()), piece.vertices.end());
  for (std::uint32_t& i : piece.indices) {
    i = static_cast<std::uint32_t>(std::ranges::lower_bound(piece.vertices, i) - piece.vertices.begin());
  }
  return piece;
}

std::vector<Piece> pieces_of(const model::Mesh& mesh) {
  const std::vector<model::MeshPart>& parts = mesh.surface().parts;
  if (parts.empty()) return {piece_of(mesh, {0, static_cast<std::uint32_t>(mesh.indices().size()), 0}, true)};
  std::vector<Piece> pieces;
  for (const model::MeshPart& part : parts) pieces.push_back(piece_of(mesh, part, parts.size() == 1));
  return pieces;
}

std::vector<float> gathered(std::span<const float> rows, std::size_t width, const std::vector<std::uint32_t>& vertices) {
  std::vector<float> out;
  out.reserve(width * vertices.size());
  for (const std::uint32_t v : vertices) {
    for (std::size_t c = 0; c < width; ++c) out.push_back(rows[width * v + c]);
  }
  return out;
}

/// To unit length; glTF knows no normal without a direction.
void make_unit(std::vector<float>& normals) {
  for (std::size_t i = 0; i < normals.size(); i += 3) {
    const double length = std::hypot(double{normals[i]}, double{normals[i + 1]}, double{normals[i + 2]});
    for (std::size_t c = 0; c < 3; ++c) {
      normals[i + c] = length > 0.0 ? static_cast<float>(normals[i + c] / length) : (c == 1 ? 1.0F : 0.0F);
    }
  }
}

class MeshWriter {
 public:
  MeshWriter(const model::Actor& actor, const ExportTargets& targets, GlbDocument& document)
      : model_(*actor.model), targets_(targets), document_(document), pieces_(pieces_of(*actor.model->mesh)) {}

  Result<std::size_t> write(const std::string& name, bool skinned, std::size_t most_bytes) {
    TWEEND_TRY(check_size(most_bytes));
    TWEEND_ASSIGN(const std::vector<std::size_t> materials, add_materials(*model_.mesh, document_));
    GlbMesh mesh{name, {}, targets_.default_weights(), targets_.names()};
    for (const Piece& piece : pieces_) mesh.primitives.push_back(primitive(piece, materials[piece.material], skinned));
    for (std::size_t t = 0; t < targets_.size(); ++t) TWEEND_TRY(add_target(t, mesh));
    document_.meshes.push_back(std::move(mesh));
    return document_.meshes.size() - 1;
  }

 private:
  /// Before anything of it is made: of a vertex clip every keyframe comes as a whole mesh.
  [[nodiscard]] Status check_size(std::size_t most_bytes) const {
    constexpr std::size_t kVertexBytes = 24;
    std::size_t vertices = 0;
    for (const Piece& piece : pieces_) vertices += piece.vertices.size();
    const std::size_t bytes = (targets_.size() + 1) * vertices * kVertexBytes;
    if (bytes <= most_bytes) return {};
    return fail(ErrorCode::Limit,
                fmt::format("expected at most {} bytes, found that {} vertices with {} morph targets (keyframes of vertices "
                            "become one each) take {}: export fewer keyframes, or obj_sequence",
                            most_bytes, vertices, targets_.size(), bytes));
  }

  GlbPrimitive primitive(const Piece& piece, std::size_t material, bool skinned) {
    const model::Mesh& mesh = *model_.mesh;
    GlbPrimitive primitive{.attributes = {}, .indices = 0, .material = material};
    const auto add = [&](const char* name, std::span<const float> values, GlbShape shape) {
      const bool bounds = std::string_view(name) == "POSITION";
      primitive.attributes.emplace_back(name, add_floats(document_, values, shape, GlbUse::Vertices, bounds));
    };
    add("POSITION", gathered(model_.rest->positions(), 3, piece.vertices), GlbShape::Vec3);
    std::vector<float> normals = gathered(model_.rest->normals(), 3, piece.vertices);
    make_unit(normals);
    add("NORMAL", normals, GlbShape::Vec3);
    if (!mesh.texcoords().empty()) {
      std::vector<float> uv = gathered(mesh.texcoords(), 2, piece.vertices);
      for (std::size_t i = 1; i < uv.size(); i += 2) uv[i] = 1.0F - uv[i];  // glTF's v goes down
      add("TEXCOORD_0", uv, GlbShape::Vec2);
    }
    if (!mesh.colors().empty()) add("COLOR_0", gathered(mesh.colors(), 4, piece.vertices), GlbShape::Vec4);
    if (skinned) add_influences(*model_.skin, piece.vertices, primitive, document_);
    primitive.indices = add_indices(document_, piece.indices);
    return primitive;
  }

  [[nodiscard]] Status add_target(std::size_t target, GlbMesh& mesh) {
    TWEEND_ASSIGN(const Displacements moved, targets_.displacements(target));
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      GlbMorph morph{add_displacements(moved.positions, moved.first_vertex, pieces_[p])};
      if (targets_.has_normals()) morph.normal = add_displacements(moved.normals, moved.first_vertex, pieces_[p]);
      mesh.primitives[p].targets.push_back(morph);
    }
    return {};
  }

  std::size_t add_displacements(std::span<const float> run, std::size_t first_vertex, const Piece& piece) {
    std::vector<float> all(3 * piece.vertices.size(), 0.0F);
    bool moves = false;
    for (std::size_t i = 0; i < piece.vertices.size(); ++i) {
      const std::size_t v = piece.vertices[i];
      if (v < first_vertex || 3 * (v - first_vertex) >= run.size()) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        all[3 * i + c] = run[3 * (v - first_vertex) + c];
        moves |= all[3 * i + c] != 0.0F;
      }
    }
    if (!moves) return add_zeros(document_, piece.vertices.size());
    return add_floats(document_, all, GlbShape::Vec3, GlbUse::Vertices, true);
  }

  const model::Model& model_;
  const ExportTargets& targets_;
  GlbDocument& document_;
  std::vector<Piece> pieces_;
};

}  // namespace

Result<std::size_t> add_mesh(const model::Actor& actor, const ExportTargets& targets, bool skinned, std::size_t most_bytes,
                             GlbDocument& document) {
  return MeshWriter(actor, targets, document).write(actor.name, skinned, most_bytes);
}

}  // namespace tweend::assets
