#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/assets/obj_reader.hpp"
#include "server/base/limits.hpp"
#include "server/base/result.hpp"
#include "server/model/mesh.hpp"
#include "server/model/vertex_key.hpp"

namespace tweend::assets {

struct ObjKey {
  double frame = 0.0;  ///< as numbered by the file; whole
  model::VertexKeyPtr vertices;
};

/// A mesh and its poses, as OBJ files hold them; how fast frames follow each other is the importer's to say.
struct ObjModel {
  std::string source;  ///< the asset's name
  model::MeshPtr mesh;
  std::vector<ObjKey> keys;           ///< at least one, in strictly ascending frame order
  std::vector<std::string> warnings;  ///< a line each: what the files name that isn't there, and was passed over
};

/// Makes one model of files that show one mesh in several poses.
///
/// A vertex is a unique tuple (v, vt of the first file, vn of every file): exporters number normals afresh for each
/// frame, so no single file tells which corners always go together. Vertices are numbered in order of first use in
/// the faces, polygons fanned from their first corner, and `v` that no face names dropped. Normals a file doesn't give,
/// or gives with zero length, are computed from its positions, weighted by area, smooth over all faces that share `v`.
///
/// The surface is that of the first file (make_surface); other files' materials are not looked at.
///
/// Pure; safe from any thread. Time is proportional to files × corners.
/// @param files   at least one, each as read_obj made it
/// @param frames  shape [files], strictly ascending, magnitudes up to 2^53
/// @param materials  shape [material names of the first file], or empty: none is known
/// @return BadAsset where two files' faces don't agree (see check_same_topology) or numbers can't be used;
///         Limit if there are too many vertices or files
[[nodiscard]] Result<ObjModel> build_obj_model(std::string source, std::span<const ObjFile> files,
                                               std::span<const std::int64_t> frames, const Limits& limits,
                                               std::span<const std::optional<model::Material>> materials = {});

/// What the name of a sequence's file says: "NAME_000010.obj" is {NAME, 10}.
struct SequenceMember {
  std::string prefix;
  std::int64_t frame;
  bool operator==(const SequenceMember&) const = default;
};

/// Nothing, unless the name is a prefix, '_', digits (of a number up to 2^53) and ".obj" in whatever case.
[[nodiscard]] std::optional<SequenceMember> parse_sequence_name(std::string_view file_name);

}  // namespace tweend::assets
