#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "server/assets/json_document.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

/// How a buffer view's bytes are compressed (EXT_meshopt_compression).
struct MeshoptView {
  enum class Mode : std::uint8_t { Attributes, Triangles, Indices };
  enum class Filter : std::uint8_t { None, Octahedral, Quaternion, Exponential };
  std::size_t count = 0;   ///< elements
  std::size_t stride = 0;  ///< bytes of an element
  Mode mode = Mode::Attributes;
  Filter filter = Filter::None;

  [[nodiscard]] std::size_t bytes() const noexcept { return count * stride; }
};

/// @param extension  the object of that name; its `buffer`, `byteOffset` and `byteLength` are not looked at
/// @return BadAsset naming what mode, filter, stride and count don't go together
[[nodiscard]] Result<MeshoptView> read_meshopt_view(const JsonNode& extension);

/// Pure. Takes memory for view.bytes() once it has seen that `packed` is long enough to hold them.
/// @param extension  for messages
[[nodiscard]] Result<std::vector<std::byte>> unpack_meshopt(const MeshoptView& view, std::span<const std::byte> packed,
                                                            const JsonNode& extension);

}  // namespace tweend::assets
