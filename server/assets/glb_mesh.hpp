#pragma once

#include <cstddef>

#include "server/assets/export_targets.hpp"
#include "server/assets/glb_document.hpp"
#include "server/base/result.hpp"
#include "server/model/actor.hpp"

namespace tweend::assets {

/// Adds the actor's mesh: a primitive for each of its parts, with the vertices that the part needs in their order (a mesh in
/// one piece keeps all of them), its materials, and what skins and morphs it.
/// @param skinned     whether its node has the skin that add_rig made
/// @param most_bytes  of the document's buffer
/// @return its place in the document. Limit for a larger one; what `targets` and write_png return
[[nodiscard]] Result<std::size_t> add_mesh(const model::Actor& actor, const ExportTargets& targets, bool skinned,
                                           std::size_t most_bytes, GlbDocument& document);

}  // namespace tweend::assets
