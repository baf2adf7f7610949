#pragma once

#include <cstddef>

#include "server/animation/skin_vertices.hpp"

namespace tweend::animation {

/// skin_vertices without its checks.
void skin_checked_vertices(const SkinInfluences& influences, std::span<const Affine> palette, const VertexAttributes& in,
                           const VertexTarget& out) noexcept;

}  // namespace tweend::animation
