#pragma once

#include <cstddef>

#include "server/assets/export_clip.hpp"
#include "server/assets/glb_document.hpp"

namespace tweend::assets {

/// Adds an animation of these samples; times that several share are written once. What moves nothing is left out: glTF has no
/// animation without channels.
/// @param mesh_node  whose weights are meant; joint nodes are numbered as the joints are
void add_animation(const std::string& name, const ClipSamples& samples, std::size_t mesh_node, GlbDocument& document);

}  // namespace tweend::assets
