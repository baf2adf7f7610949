#pragma once

#include <optional>
#include <span>

#include "server/assets/obj_reader.hpp"
#include "server/model/material.hpp"

namespace tweend::assets {

/// Whether any corner of `file` has texture coordinates.
[[nodiscard]] bool has_texcoords(const ObjFile& file);

/// What the mesh of `file` looks like: a part for each longest run of faces, as fanned triangles, of one material;
/// materials in order of first use. Faces without a known material show a default one of no name, and where no face
/// has a known one, the surface is empty.
/// @param materials  shape [file.material_names], or empty; nothing: not known
[[nodiscard]] model::Surface make_surface(const ObjFile& file, std::span<const std::optional<model::Material>> materials);

}  // namespace tweend::assets
