#pragma once

#include "server/assets/obj_reader.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

/// Whether `file` shows the mesh of `first` in another pose: as many vertices (v statements) and faces, each face
/// naming the same vertices in the same order. Texture coordinates and normals may be numbered otherwise.
/// @return BadAsset naming both files, both counts and the lines at which they part
[[nodiscard]] Status check_same_topology(const ObjFile& first, const ObjFile& file);

}  // namespace tweend::assets
