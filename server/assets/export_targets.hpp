#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/assets/export_names.hpp"
#include "server/assets/rest_vertices.hpp"
#include "server/base/result.hpp"
#include "server/model/actor.hpp"

namespace tweend::assets {

/// How one weight of an exported mesh displaces its vertices: a run of them, the others stay.
struct Displacements {
  std::size_t first_vertex = 0;
  std::vector<float> positions;  ///< shape [run × 3]
  std::vector<float> normals;    ///< the same shape, or empty
};

/// The morph targets of an exported mesh: the actor's own, then one for each different keyframe of its vertex clips, which are
/// told as displacements from the mesh at rest. Keyframes that show the mesh at rest need none.
///
/// Where a vertex clip plays, its targets' weights sum up to 1 less the share of such keyframes, and all others are 0: then
/// base + Σ weight · (key − base) is Σ weight · key.
class ExportTargets {
 public:
  /// @param actor  with a mesh; outlives this
  explicit ExportTargets(const model::Actor& actor);

  [[nodiscard]] std::size_t size() const noexcept { return names_.size(); }
  /// Those of the clips are called `CLIP:3` after the place of their first keyframe.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  /// Shape [size()]; those of clips are 0.
  [[nodiscard]] const std::vector<float>& default_weights() const noexcept { return weights_; }
  /// Whether any of them turns normals.
  [[nodiscard]] bool has_normals() const noexcept;
  /// The target of a keyframe; nothing where it shows the mesh at rest.
  [[nodiscard]] std::optional<std::size_t> of_key(const model::VertexKey& key) const;
  /// @return InvalidParams where a keyframe's vertices can't be told so; see RestPose
  [[nodiscard]] Result<Displacements> displacements(std::size_t target) const;

 private:
  void add_keys(const model::Clip& clip);
  void add_key(const model::Clip& clip, std::size_t key);

  const model::Actor& actor_;
  RestPose rest_;
  ExportNames unique_;
  std::size_t own_ = 0;  ///< the actor's own come first
  std::vector<std::string> names_;
  std::vector<float> weights_;
  std::vector<model::VertexKeyPtr> keys_;  ///< of the others
  std::map<model::ContentHash, std::size_t> target_of_;
};

}  // namespace tweend::assets
