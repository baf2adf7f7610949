#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "server/base/result.hpp"
#include "server/model/actor.hpp"

namespace tweend::assets {

/// The joint that carries the whole mesh as it is: nothing is skinned then, the mesh just hangs on it.
[[nodiscard]] std::optional<std::size_t> rigid_joint(const model::Model& model) noexcept;

/// Vertices before skinning.
struct RestVertices {
  std::vector<float> positions;  ///< shape [vertices × 3]
  std::vector<float> normals;    ///< directions, of any length
};

/// Undoes the skinning of a skeleton at rest: what it finds, skinned again by the joints at rest, is what was given. Blends of
/// several such vertices come out as the same blends, as skinning is linear while the joints stand still.
class RestPose {
 public:
  explicit RestPose(const model::Actor& actor);

  /// Whether vertices are shown as they are: no skin, or one that leaves them where they are.
  [[nodiscard]] bool is_identity() const noexcept { return matrices_.empty(); }

  /// @param key  vertices of the actor's mesh as they are shown
  /// @return InvalidParams, path "params.actor", where joints at rest scale a vertex away, so that nothing brings it back
  [[nodiscard]] Result<RestVertices> unskinned(const model::VertexKey& key) const;

 private:
  const model::Actor& actor_;
  std::vector<animation::Affine> matrices_;  ///< of the skin's entries; empty: they are identity
};

}  // namespace tweend::assets
