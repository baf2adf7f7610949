#pragma once

#include <optional>
#include <string_view>

#include "server/base/result.hpp"

namespace tweend::assets {

/// The parts of a glTF file, borrowed from its bytes.
struct GltfContainer {
  std::string_view json;
  std::optional<std::string_view> bin;  ///< of a .glb: its binary chunk, if it has one
};

/// Takes a glTF file apart: a .glb by its first four bytes (glTF 2.0, section 4.4), anything else is JSON.
/// Pure; allocates nothing.
/// @param name  as messages call it
/// @return BadAsset naming the byte where a header or chunk is not what it must be
[[nodiscard]] Result<GltfContainer> open_gltf_container(std::string_view bytes, std::string_view name);

}  // namespace tweend::assets
