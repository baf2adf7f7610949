#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "server/animation/affine.hpp"
#include "server/animation/skin_vertices.hpp"
#include "server/base/result.hpp"
#include "server/model/bounds.hpp"
#include "server/model/content_hash.hpp"

namespace tweend::model {

/// A matrix that moves vertices: a joint of a skin, or a node that carries a mesh of its own.
struct SkinEntry {
  std::uint32_t joint = 0;              ///< in the skeleton's given order
  animation::Affine joint_from_mesh{};  ///< the inverse bind matrix; identity for the mesh of a node
};

/// How the joints of a skeleton move the vertices of a mesh. A mesh that hangs on a node is one whose vertices follow that one
/// joint alone: rigid animation and skinning are the same. Immutable.
class Skin {
 public:
  /// @param entries     1 to 65536
  /// @param per_vertex  influences a vertex: 1, 4 or 8
  /// @param joints      shape [vertices × per_vertex], indices into entries
  /// @param weights     the same shape, >= 0; each vertex' are scaled to sum 1, all zero counts as its first entry alone
  /// @param positions   shape [vertices × 3], of the mesh at rest
  /// @return InvalidParams naming a wrong length, or the first index or weight that is out of range
  [[nodiscard]] static Result<std::shared_ptr<const Skin>> make(std::vector<SkinEntry> entries, std::size_t per_vertex,
                                                                std::vector<std::uint16_t> joints, std::vector<float> weights,
                                                                std::span<const float> positions);

  [[nodiscard]] const std::vector<SkinEntry>& entries() const noexcept { return entries_; }
  [[nodiscard]] std::size_t per_vertex() const noexcept { return per_vertex_; }
  [[nodiscard]] animation::SkinInfluences influences() const noexcept { return {per_vertex_, joints_, weights_}; }
  /// For each entry, around the vertices at rest that it moves, in the mesh's space; of one that moves none, inverted
  /// (min > max).
  [[nodiscard]] const std::vector<Bounds>& entry_bounds() const noexcept { return entry_bounds_; }
  [[nodiscard]] const ContentHash& hash() const noexcept { return hash_; }

 private:
  Skin() = default;
  std::vector<SkinEntry> entries_;
  std::size_t per_vertex_ = 0;
  std::vector<std::uint16_t> joints_;
  std::vector<float> weights_;
  std::vector<Bounds> entry_bounds_;
  ContentHash hash_;
};

using SkinPtr = std::shared_ptr<const Skin>;

}  // namespace tweend::model
