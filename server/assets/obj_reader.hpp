#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "server/base/limits.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

/// One corner of a face: indices from 0 into the file's lists, -1 where the file gives none.
struct ObjCorner {
  std::int32_t v;  ///< always given
  std::int32_t vt;
  std::int32_t vn;
  bool operator==(const ObjCorner&) const = default;
};

/// An ObjFace's material where no `usemtl` with a name stands before it.
inline constexpr std::int32_t kNoMaterial = -1;

/// A polygon: corners [first_corner, first_corner + corner_count) of the file, at least 3.
struct ObjFace {
  std::uint32_t first_corner;
  std::uint32_t corner_count;
  std::uint32_t line;                   ///< where its statement begins, from 1
  std::int32_t material = kNoMaterial;  ///< which of the file's material names
  bool operator==(const ObjFace&) const = default;
};

/// What a Wavefront OBJ file says about its polygons. Every index is within its list, every number finite.
struct ObjFile {
  std::string name;              ///< as messages call it: the asset's path
  std::vector<float> positions;  ///< shape [v statements × 3], as they stand: metres, +Y up by convention
  std::vector<float> texcoords;  ///< shape [vt statements × 2], v upwards
  std::vector<float> normals;    ///< shape [vn statements × 3], of any length
  std::vector<ObjCorner> corners;
  std::vector<ObjFace> faces;
  std::vector<std::string> material_names;      ///< of `usemtl`: each once, in order of first use
  std::vector<std::string> material_libraries;  ///< of `mtllib`: each statement's once, as it stands: one name or several
};

/// Reads one OBJ file strictly: every token of `v`, `vt`, `vn` and `f` must be understood to its end. `usemtl` and
/// `mtllib` take the rest of their line as it stands; without a name, `usemtl` ends the use of a material. Statements
/// about names, smoothing, lines, points and free-form curves are skipped; one that OBJ doesn't have is an error.
/// Indices may point forwards in the file; negative ones count back from where they stand.
///
/// Pure; time and memory are proportional to the text. Safe from any thread.
/// @return BadAsset as "name:line: expected …, found …"; Limit if there are too many vertices, or more than 256
///         statements name libraries
[[nodiscard]] Result<ObjFile> read_obj(std::string_view text, std::string name, const Limits& limits);

}  // namespace tweend::assets
