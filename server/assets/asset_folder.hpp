#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "server/assets/asset_root.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

/// A file of an OBJ sequence.
struct SequenceFile {
  std::string name;  ///< the asset path, with its folder
  std::string prefix;
  std::int64_t frame = 0;
  std::uint64_t bytes = 0;
};

/// A folder's entries, by what they are to us. Dot files, names that couldn't be asked for (is_clean_name) and other
/// files are in none of the lists.
struct AssetFolder {
  std::vector<SequenceFile> members;  ///< NAME_000000.obj; if there are any, the folder is a sequence
  std::vector<AssetEntry> objs;       ///< other .obj files
  std::vector<AssetEntry> gltfs;      ///< .glb and .gltf files
  std::vector<AssetEntry> subfolders;
};

/// @param name     of the folder, for the members' paths
/// @param entries  as AssetRoot::list_folder lists them
[[nodiscard]] AssetFolder sort_entries(std::string_view name, std::vector<AssetEntry> entries);

/// Bytes of all the members.
[[nodiscard]] std::uint64_t total_bytes(const std::vector<SequenceFile>& members) noexcept;

/// The members in ascending order of their frames.
/// @return BadAsset naming two files, if they have different prefixes or the same frame
[[nodiscard]] Result<std::vector<SequenceFile>> order_sequence(std::vector<SequenceFile> members);

}  // namespace tweend::assets
