#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "server/assets/gltf_progress.hpp"
#include "server/assets/gltf_uri.hpp"
#include "server/base/limits.hpp"
#include "server/base/result.hpp"
#include "server/model/model.hpp"

namespace tweend::assets {

/// Reads a glTF 2.0 file, .glb or .gltf, and what it refers to: the default scene's nodes as a skeleton, its meshes as one mesh
/// with skin and morph targets, its animations as clips (an empty one, `default`, where there is none). Cameras, lights and
/// extensions that nobody requires are ignored; what else is passed over is told by warnings.
///
/// Strict: every offset, count and index is checked before it is used, and no memory is taken for a count that neither the
/// bytes there are nor a limit stand for. Pure but for `read_side_file`; safe from any thread.
/// @param name            the asset's, under its assets folder
/// @param read_side_file  for buffers and images in files of their own
/// @param max_side_bytes  of those files together
/// @return BadAsset naming the file and the JSON pointer, what was expected there and what was found; Limit likewise
[[nodiscard]] Result<model::ImportedModel> read_gltf(std::string_view bytes, const std::string& name,
                                                     ReadSideFile read_side_file, std::size_t max_side_bytes,
                                                     const Limits& limits, ImportProgress progress = {});

/// What a glTF file lists, whether or not its default scene shows it; for people to read.
struct GltfFacts {
  std::string version;
  std::string generator;
  std::vector<std::string> extensions_used;
  std::vector<std::string> extensions_required;
  std::size_t scenes = 0, nodes = 0, meshes = 0, skins = 0, animations = 0, materials = 0, textures = 0, images = 0,
              cameras = 0;
};

/// @return as read_gltf, for what is wrong with the container or the JSON itself
[[nodiscard]] Result<GltfFacts> read_gltf_facts(std::string_view bytes, const std::string& name, const Limits& limits);

}  // namespace tweend::assets
