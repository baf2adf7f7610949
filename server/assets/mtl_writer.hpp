#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/assets/new_file.hpp"
#include "server/base/result.hpp"
#include "server/model/material.hpp"

namespace tweend::assets {

/// What each material of a surface is called in an MTL file, in the surface's order.
using MtlNames = std::vector<std::string>;

struct MtlFiles {
  MtlNames names;              ///< none twice
  std::vector<NewFile> files;  ///< `PREFIX.mtl` and `PREFIX_0.png` …; none where there is no material
};

/// The materials of a surface as MTL: Kd, map_Kd, and d where one is not opaque. Names keep their printable ASCII but for
/// blanks and '#'; what else they have becomes '_'.
/// @param textured  whether the mesh has texture coordinates; textures are left out otherwise
/// @return what write_png returns
[[nodiscard]] Result<MtlFiles> write_mtl(const model::Surface& surface, bool textured, std::string_view prefix);

}  // namespace tweend::assets
