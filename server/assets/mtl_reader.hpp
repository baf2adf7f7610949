#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/base/result.hpp"

namespace tweend::assets {

/// What a Wavefront MTL file says about one material's diffuse reflection.
struct MtlMaterial {
  std::string name;
  std::optional<glm::vec3> diffuse;  ///< Kd as it stands: finite, sRGB (as three.js's MTLLoader takes it)
  std::string diffuse_map;           ///< map_Kd's file as named, but with '/' between folders; empty: none
  bool operator==(const MtlMaterial&) const = default;
};

/// Reads an MTL file strictly: every token of `newmtl`, `Kd` and `map_Kd`, in whatever case, must be understood. The
/// other statements that MTL and its extension for physically based shading have are skipped; any other is an error.
///
/// Names and file names are the rest of their lines, with their blanks. The options of `map_Kd` are skipped; without a
/// file name it says nothing. A later material of the same name replaces the earlier one, and so does a later
/// statement within a material, as in three.js's MTLLoader.
/// Pure; time and memory are proportional to the text. Safe from any thread.
/// @param name  as messages call the file
/// @return in the order in which the names first occur; BadAsset as "name:line: expected …, found …"
[[nodiscard]] Result<std::vector<MtlMaterial>> read_mtl(std::string_view text, std::string_view name);

}  // namespace tweend::assets
