#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "server/assets/asset_root.hpp"
#include "server/assets/obj_reader.hpp"
#include "server/base/limits.hpp"
#include "server/base/result.hpp"
#include "server/model/material.hpp"

namespace tweend::assets {

struct ObjMaterials {
  std::vector<std::optional<model::Material>> materials;  ///< shape [file.material_names]; nothing: not known or not used
  std::vector<std::string> warnings;                      ///< a line each; past 16 the last one counts the rest
};

/// Reads the material libraries that `file` names, and the textures of those materials that its faces use.
///
/// A `mtllib` statement names one file, if there is one of that name with all its blanks; otherwise its tokens are names
/// of a file each, up to one that begins with '#'. Of materials of one name the later one wins. Libraries and textures are
/// looked for from the folder of `file`, each is read once, and a texture only if there are texture coordinates to map
/// it by. A material without Kd is white under its texture, and of the default colour without one.
///
/// What is absent is passed over with a warning, since exporters leave such names everywhere: a library, a texture or
/// a material that isn't there, or lies outside of the assets folder. What is there must be sound.
/// Blocks on the disk. Safe from any thread.
/// @param file       its name is its path under `root`
/// @param max_bytes  of all the files read
/// @return BadAsset naming the file, and a library's line; Limit for too many bytes, pixels or libraries
[[nodiscard]] Result<ObjMaterials> load_obj_materials(const AssetRoot& root, const ObjFile& file, std::size_t max_bytes,
                                                      const Limits& limits);

}  // namespace tweend::assets
