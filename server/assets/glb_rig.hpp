#pragma once

#include <cstddef>

#include "server/assets/glb_document.hpp"
#include "server/model/actor.hpp"

namespace tweend::assets {

/// Adds the joints as nodes in their order, each at rest, and what the mesh needs of nodes and a skin. A node may be in a skin
/// once: an entry whose joint another has already gets a node of its own, at rest on that joint.
///
/// The mesh hangs on a root of its own, called like the actor, unless a root is there that says nothing (at identity, without
/// children, moved by no clip, moving no vertex): so files that are read and written again and again do not grow. A rigid mesh
/// hangs on its joint.
/// @return the mesh's node; of a skeleton alone the first one
std::size_t add_rig(const model::Actor& actor, GlbDocument& document);

}  // namespace tweend::assets
