#pragma once

#include <cstdint>
#include <span>

#include "server/assets/glb_document.hpp"
#include "server/model/skin.hpp"

namespace tweend::assets {

/// Adds JOINTS_0 and WEIGHTS_0, and JOINTS_1 and WEIGHTS_1 where vertices have more than four influences, as strict readers
/// want them: no joint twice, joint 0 where the weight is 0, sums of 1.
/// @param vertices  of the skin's mesh
void add_influences(const model::Skin& skin, std::span<const std::uint32_t> vertices, GlbPrimitive& primitive,
                    GlbDocument& document);

}  // namespace tweend::assets
