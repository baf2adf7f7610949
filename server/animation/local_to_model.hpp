#pragma once

#include <cstdint>
#include <span>

#include "server/animation/affine.hpp"
#include "server/animation/pose.hpp"

namespace tweend::animation {

/// model_from_joint[j] = model_from_joint[parents[j]] · T · R · S, in one pass.
/// Pure; allocates nothing.
/// @param parents           shape [joint_count]; of a root -1, of any other joint one before it
/// @param model_from_joint  shape [joint_count]
/// Preconditions: those shapes, and the order.
void local_to_model(std::span<const std::int32_t> parents, const Pose& pose, std::span<Affine> model_from_joint) noexcept;

}  // namespace tweend::animation
