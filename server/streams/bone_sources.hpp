#pragma once

#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "render/picture.hpp"
#include "server/animation/affine.hpp"
#include "server/model/skeleton.hpp"

namespace tweend::streams {

/// Adds a skeleton as it is drawn: a ball for each joint, whose size follows the longest bone that ends there, and a bone from
/// each joint's parent to it. Only growing `out` allocates.
/// @param model_from_joint  by place
/// @param focus_m           how far away the picture looks: of a skeleton without any length balls take their size from it
void add_bones(const model::Skeleton& skeleton, std::span<const animation::Affine> model_from_joint,
               const glm::mat4& world_from_model, float focus_m, std::vector<render::BoneSource>& out);

}  // namespace tweend::streams
