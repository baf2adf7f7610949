#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "server/animation/morph_vertices.hpp"
#include "server/base/result.hpp"
#include "server/model/content_hash.hpp"

namespace tweend::model {

/// How one weight displaces a run of a mesh's vertices.
struct MorphTarget {
  std::string name;             ///< unique among its actor's targets, verbatim UTF-8
  float default_weight = 0.0F;  ///< where nothing is keyed
  std::size_t first_vertex = 0;
  std::vector<float> positions;  ///< displacements at weight 1, shape [run × 3], the mesh's space, metres
  std::vector<float> normals;    ///< the same shape, or empty
  std::vector<float> tangents;   ///< the same shape, or empty
};

/// All morph targets of a mesh, in the order of their weights. Immutable.
class MorphTargets {
 public:
  /// @return InvalidParams naming a target whose run or numbers are out of range, or a name that comes twice
  [[nodiscard]] static Result<std::shared_ptr<const MorphTargets>> make(std::vector<MorphTarget> targets,
                                                                        std::size_t vertex_count);

  [[nodiscard]] std::size_t size() const noexcept { return targets_.size(); }
  [[nodiscard]] const std::vector<MorphTarget>& targets() const noexcept { return targets_; }
  [[nodiscard]] std::span<const animation::MorphTargetView> views() const noexcept { return views_; }
  /// Shape [size()].
  [[nodiscard]] std::span<const float> default_weights() const noexcept { return default_weights_; }
  /// The longest way any vertex goes with all weights at 1, metres.
  [[nodiscard]] float reach() const noexcept { return reach_; }
  [[nodiscard]] const ContentHash& hash() const noexcept { return hash_; }

 private:
  MorphTargets() = default;
  std::vector<MorphTarget> targets_;
  std::vector<animation::MorphTargetView> views_;
  std::vector<float> default_weights_;
  float reach_ = 0.0F;
  ContentHash hash_;
};

using MorphTargetsPtr = std::shared_ptr<const MorphTargets>;

}  // namespace tweend::model
