#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "server/assets/gltf_accessors.hpp"
#include "server/assets/gltf_scene.hpp"
#include "server/model/skin.hpp"

namespace tweend::assets {

/// The matrices that move a scene's vertices: a run for each skin that is used, and one for each node that carries a mesh of
/// its own. Not thread-safe.
class GltfSkins {
 public:
  /// A run of take().
  struct Run {
    std::size_t first = 0;
    std::size_t count = 0;
  };

  /// All outlive this.
  GltfSkins(const GltfFile& file, const GltfScene& scene, GltfAccessors& accessors)
      : file_(file), scene_(scene), accessors_(accessors) {}

  /// @param reference  the index of a skin
  /// @return BadAsset for joints outside of the scene, or inverse bind matrices that don't fit; Limit for too many matrices
  [[nodiscard]] Result<Run> skin(const JsonNode& reference);
  /// The one matrix of a node's own mesh.
  [[nodiscard]] Result<Run> node(std::uint32_t joint);

  [[nodiscard]] std::vector<model::SkinEntry> take() { return std::move(entries_); }

 private:
  [[nodiscard]] Status check_room(const JsonNode& at, std::size_t count) const;

  const GltfFile& file_;
  const GltfScene& scene_;
  GltfAccessors& accessors_;
  std::vector<model::SkinEntry> entries_;
  std::map<std::size_t, Run> runs_;  ///< by index of the skin
};

}  // namespace tweend::assets
