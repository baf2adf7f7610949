#include "server/assets/asset_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "server/assets/asset_name.hpp"
#include "server/assets/obj_sequence.hpp"

namespace tweend::assets {

AssetFolder sort_entries(std::string_view name, std::vector<AssetEntry> entries) {
  AssetFolder folder;
  for (AssetEntry& entry : entries) {
    if (entry.name.starts_with('.') || !is_clean_name(entry.name)) continue;
    if (entry.directory) {
      folder.subfolders.push_back(std::move(entry));
    } else if (std::optional<SequenceMember> member = parse_sequence_name(entry.name)) {
      folder.members.push_back({join_name(name, entry.name), std::move(member->prefix), member->frame, entry.bytes});
    } else if (has_extension(entry.name, ".obj")) {
      folder.objs.push_back(std::move(entry));
    } else if (is_gltf_name(entry.name)) {
      folder.gltfs.push_back(std::move(entry));
    }
  }
  return folder;
}

std::uint64_t total_bytes(const std::vector<SequenceFile>& members) noexcept {
  std::uint64_t total = 0;
  for (const SequenceFile& member : members) {
    // Sparse files can claim any length: stay at the top rather than wrap.
    if (member.bytes > std::numeric_limits<std::uint64_t>::max() - total) return std::numeric_limits<std::uint64_t>::max();
    total += member.bytes;
  }
  return total;
}

Result<std::vector<SequenceFile>> order_sequence(std::vector<SequenceFile> members) {
  std::sort(members.begin(), members.end(),
            [](const SequenceFile& a, const SequenceFile& b) { return std::tie(a.frame, a.name) < std::tie(b.frame, b.name); });
  for (std::size_t i = 1; i < members.size(); ++i) {
    if (members[i].prefix != members.front().prefix) {
      return fail(ErrorCode::BadAsset,
                  fmt::format("expected the files of a sequence to have one name before the number, found {} and {}",
                              quoted_name(members.front().name), quoted_name(members[i].name)));
    }
    if (members[i].frame == members[i - 1].frame) {
      return fail(ErrorCode::BadAsset, fmt::format("expected one file for frame {}, found {} and {}", members[i].frame,
                                                   quoted_name(members[i - 1].name), quoted_name(members[i].name)));
    }
  }
  return members;
}

}  // namespace tweend::assets
