#pragma once

#include <memory>
#include <span>
#include <vector>

#include "server/animation/vertex_attributes.hpp"
#include "server/base/result.hpp"
#include "server/model/bounds.hpp"
#include "server/model/content_hash.hpp"
#include "server/model/mesh.hpp"

namespace tweend::model {

/// The whole mesh at one instant (seed: "snapshots of a mesh with different poses"), in model space:
/// one block of positions, then unit normals, then, where the mesh has texture coordinates, unit tangents,
/// each 3 floats a vertex. Immutable, shared by all revisions and readers, named by its content.
class VertexKey {
 public:
  /// Normals are scaled to unit length; those not given, and zero ones, are computed from the mesh's triangles,
  /// weighted by area. Tangents are computed where the mesh has texture coordinates.
  /// @param positions  shape [vertex_count × 3], finite, metres
  /// @param normals    the same shape, finite; or empty
  /// @return InvalidParams naming both counts, or the first number that is not finite. The error's path is
  ///         "positions" or "normals", for the caller to put behind its own.
  [[nodiscard]] static Result<std::shared_ptr<const VertexKey>> make(const Mesh& mesh, std::span<const float> positions,
                                                                     std::span<const float> normals = {});

  /// One that block() was taken from: the same numbers, the same hash.
  /// @param block  finite; shape [vertex_count × 9] for a mesh with texture coordinates, else [vertex_count × 6]
  /// @return InvalidParams for another length, or a number that is not finite
  [[nodiscard]] static Result<std::shared_ptr<const VertexKey>> from_block(const Mesh& mesh, std::vector<float> block);

  [[nodiscard]] std::size_t vertex_count() const noexcept { return vertex_count_; }
  [[nodiscard]] std::span<const float> positions() const noexcept;
  [[nodiscard]] std::span<const float> normals() const noexcept;
  /// Empty where the mesh has no texture coordinates.
  [[nodiscard]] std::span<const float> tangents() const noexcept;
  /// All of it in one piece: positions, normals, tangents if there are any.
  [[nodiscard]] std::span<const float> block() const noexcept { return block_; }
  [[nodiscard]] animation::VertexAttributes attributes() const noexcept;
  /// In model space.
  [[nodiscard]] const Bounds& bounds() const noexcept { return bounds_; }
  [[nodiscard]] const ContentHash& hash() const noexcept { return hash_; }

 private:
  VertexKey() = default;
  std::size_t vertex_count_ = 0;
  std::vector<float> block_;
  Bounds bounds_;
  ContentHash hash_;
};

using VertexKeyPtr = std::shared_ptr<const VertexKey>;

}  // namespace tweend::model
