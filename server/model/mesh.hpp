#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "server/base/result.hpp"
#include "server/model/content_hash.hpp"
#include "server/model/material.hpp"

namespace tweend::model {

/// What all keyframes of an actor share: which vertices make triangles, texture coordinates, materials.
/// Immutable once made; shared by every revision that shows it.
class Mesh {
 public:
  /// @param vertex_count  vertices of every keyframe, at least 1
  /// @param indices       shape [triangles × 3], counter-clockwise fronts, each < vertex_count
  /// @param texcoords     shape [vertex_count × 2], v upwards as in OBJ files; empty: none
  /// @param surface       its parts cover all indices in order and name materials that are there; or it is empty
  /// @param colors        shape [vertex_count × 4], linear red green blue alpha, 0 to 1; multiplies the base colour; empty:
  /// none
  /// @return InvalidParams naming the first bad index, part or the wrong length
  [[nodiscard]] static Result<std::shared_ptr<const Mesh>> make(std::size_t vertex_count, std::vector<std::uint32_t> indices,
                                                                std::vector<float> texcoords = {}, Surface surface = {},
                                                                std::vector<float> colors = {});

  [[nodiscard]] std::size_t vertex_count() const noexcept { return vertex_count_; }
  [[nodiscard]] std::size_t triangle_count() const noexcept { return indices_.size() / 3; }
  [[nodiscard]] std::span<const std::uint32_t> indices() const noexcept { return indices_; }
  [[nodiscard]] std::span<const float> texcoords() const noexcept { return texcoords_; }
  [[nodiscard]] std::span<const float> colors() const noexcept { return colors_; }
  [[nodiscard]] const Surface& surface() const noexcept { return surface_; }
  [[nodiscard]] const ContentHash& hash() const noexcept { return hash_; }

 private:
  Mesh() = default;
  std::size_t vertex_count_ = 0;
  std::vector<std::uint32_t> indices_;
  std::vector<float> texcoords_;
  std::vector<float> colors_;
  Surface surface_;
  ContentHash hash_;
};

using MeshPtr = std::shared_ptr<const Mesh>;

}  // namespace tweend::model
