#pragma once

#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "render/picture.hpp"
#include "server/animation/affine.hpp"
#include "server/model/skeleton.hpp"

namespace tweend::streams {

/// Adds a skeleton as it is drawn: a ball for each joint, whose size follows the longest bone that ends there, and a bone from
/// each joint's parent to it. Balls of a skeleton without any length have none of their own: see size_lone_balls. Only growing
/// `out` allocates.
/// @param model_from_joint  by place
void add_bones(const model::Skeleton& skeleton, std::span<const animation::Affine> model_from_joint,
               const glm::mat4& world_from_model, std::vector<render::BoneSource>& out);

/// Gives balls without a size one that can be seen.
/// @param focus_m  how far away the picture looks
void size_lone_balls(float focus_m, std::vector<render::BoneSource>& bones);

}  // namespace tweend::streams
