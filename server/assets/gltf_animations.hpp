#pragma once

#include <optional>
#include <span>
#include <vector>

#include "server/assets/gltf_accessors.hpp"
#include "server/assets/gltf_mesh.hpp"
#include "server/assets/gltf_progress.hpp"
#include "server/assets/gltf_scene.hpp"
#include "server/assets/gltf_warnings.hpp"
#include "server/base/limits.hpp"
#include "server/base/result.hpp"
#include "server/model/clip.hpp"

namespace tweend::assets {

/// Makes a clip of each animation: a keyframe for every time at which a sampler has a key, with what is keyed then; how its
/// tracks blend stands in the clip's channel modes. Channels without a node, of nodes outside the default scene, or of targets
/// this reader does not know are passed over. Times that no keyframes may have, less than kSameTimeSeconds apart, become one,
/// or move apart where one sampler has both.
/// @return BadAsset; Limit for more than Limits::clips_per_actor, keyframes_per_clip or keyed_values
[[nodiscard]] Result<std::vector<model::Clip>> read_gltf_animations(const GltfFile& file, const GltfScene& scene,
                                                                    const GltfMesh& mesh, GltfAccessors& accessors,
                                                                    const Limits& limits, GltfWarnings& warnings,
                                                                    GltfProgress& progress);

}  // namespace tweend::assets
