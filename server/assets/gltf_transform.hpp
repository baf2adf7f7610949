#pragma once

#include "server/animation/joint_pose.hpp"
#include "server/assets/gltf_warnings.hpp"
#include "server/assets/json_document.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

/// The local transform of a glTF node: its translation, rotation and scale, or its matrix taken apart. A matrix that is more
/// than those three (a shear) is brought as near as they can, with a warning.
/// @return BadAsset for numbers that are none, a rotation of zero length, a matrix beside others of the four
[[nodiscard]] Result<animation::JointPose> read_gltf_transform(const JsonNode& node, GltfWarnings& warnings);

}  // namespace tweend::assets
