#pragma once

#include <cstddef>
#include <vector>

#include "server/assets/glb_document.hpp"
#include "server/base/result.hpp"
#include "server/model/mesh.hpp"

namespace tweend::assets {

/// Adds the materials of a mesh and their textures, each picture once, as PNG. A mesh that says nothing of its look gets the
/// one it is drawn with here: glTF's own default is white.
/// @return their places in the document, in the mesh's order; at least one. What write_png returns
[[nodiscard]] Result<std::vector<std::size_t>> add_materials(const model::Mesh& mesh, GlbDocument& document);

}  // namespace tweend::assets
