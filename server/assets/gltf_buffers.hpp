#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/assets/gltf_file.hpp"
#include "server/assets/gltf_uri.hpp"
#include "server/base/limits.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

/// The bytes of a buffer view, unpacked where they are compressed.
struct GltfView {
  std::span<const std::byte> bytes;
  std::size_t stride = 0;  ///< bytes from one element to the next; 0: elements stand side by side
};

/// The buffers and buffer views of a glTF file, each fetched when it is first asked for and kept. Not thread-safe.
class GltfBuffers {
 public:
  /// @param file, uris, limits  outlive this
  GltfBuffers(const GltfFile& file, GltfUris& uris, const Limits& limits)
      : file_(file), uris_(uris), unpacked_bytes_left_(limits.asset_bytes) {}

  /// @param reference  the index of a buffer view
  /// @return BadAsset naming what does not fit; Limit for more than Limits::asset_bytes, read or unpacked
  [[nodiscard]] Result<GltfView> view(const JsonNode& reference);

 private:
  using Bytes = std::span<const std::byte>;
  [[nodiscard]] Result<Bytes> buffer(const JsonNode& reference);
  [[nodiscard]] Result<Bytes> load(const JsonNode& buffer);
  /// The part of a buffer that `node` names: a buffer view, or an extension that says where the packed bytes are.
  [[nodiscard]] Result<Bytes> slice(const JsonNode& node);
  [[nodiscard]] Result<Bytes> unpack(const JsonNode& view, const JsonNode& extension);

  const GltfFile& file_;
  GltfUris& uris_;
  std::size_t unpacked_bytes_left_;
  std::map<std::size_t, std::string> fetched_;              ///< buffers that are not in the file itself
  std::map<std::size_t, Bytes> buffers_;                    ///< by index
  std::map<std::size_t, std::vector<std::byte>> unpacked_;  ///< by index of the view
  std::map<std::size_t, GltfView> views_;                   ///< by index
};

}  // namespace tweend::assets
