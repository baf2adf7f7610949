#pragma once

#include <span>

#include "server/animation/pose.hpp"

namespace tweend::animation {

/// pose = pose + weight · (to − pose), joint by joint: translations, scales and morph weights lerp, rotations slerp the short
/// way. Weight 0 leaves `pose` and weight 1 gives `to`, bit for bit. Pure; allocates nothing.
/// @param weight  0 to 1
/// @param mask    shape [joint_count], 0 to 1, multiplies the weight of each joint; empty: all 1. Morph weights are blended
///                only without a mask
/// Precondition: both poses have the same joints and weights.
void blend_poses(const Pose& to, float weight, std::span<const float> mask, Pose& pose) noexcept;

/// Adds the difference between `layer` and `rest`: translations and morph weights add, rotations turn by the weighted part of
/// rest⁻¹ · layer, scales multiply by the weighted part of layer / rest (1 where rest is 0). Otherwise as above.
void add_pose(const Pose& layer, const Pose& rest, float weight, std::span<const float> mask, Pose& pose) noexcept;

}  // namespace tweend::animation
