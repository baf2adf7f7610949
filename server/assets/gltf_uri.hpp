#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "server/assets/json_document.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

/// Reads a file beside an asset by its clean name (is_clean_name) under the assets folder.
/// @return as AssetRoot::read_file
using ReadSideFile = std::function<Result<std::string>(std::string_view name, std::size_t max_bytes)>;

/// Fetches what the `uri`s of a glTF file name: data URIs, and files in the folders beside and below it. Others are refused:
/// absolute paths, schemes such as http:, and ways out of the assets folder.
class GltfUris {
 public:
  /// @param file       the asset's own name, from whose folder the others are looked for
  /// @param max_bytes  of all files read through this
  GltfUris(std::string file, ReadSideFile read, std::size_t max_bytes)
      : file_(std::move(file)), read_(std::move(read)), bytes_left_(max_bytes) {}

  /// @param uri  a text of the file
  /// @return BadAsset naming `uri`'s place and what it says; Limit for too many bytes
  [[nodiscard]] Result<std::string> fetch(const JsonNode& uri);

 private:
  std::string file_;
  ReadSideFile read_;
  std::size_t bytes_left_;
};

}  // namespace tweend::assets
