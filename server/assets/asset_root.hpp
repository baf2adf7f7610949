#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/assets/new_asset_file.hpp"
#include "server/assets/new_file.hpp"
#include "server/assets/open_beneath.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

/// A file or folder under an assets folder.
struct AssetEntry {
  std::string name;  ///< of a listing: the last component; of `find`: the name asked for
  bool directory = false;
  std::uint64_t bytes = 0;  ///< of a file; 0 for a folder
  bool link = false;        ///< reached by a symbolic link (of a listing only): whoever walks a tree can loop here
};

/// A folder whose files may be read, and new ones saved, and nothing outside of it. It is opened once and held open; everything
/// under it is opened beneath that descriptor (open_beneath), so a symbolic link that leaves leads nowhere, while one that
/// stays may be followed.
///
/// Names are as is_clean_name asks; every other name is answered NotFound, as is one that leaves.
/// Move-only. Const methods are safe from any thread and block on the disk.
class AssetRoot {
 public:
  /// @return NotFound naming the folder and the system's reason
  [[nodiscard]] static Result<AssetRoot> open(const std::string& folder);

  /// The bytes of a regular file; pipes, devices and folders are refused without blocking on them.
  /// @return NotFound, Limit if it's longer than `max_bytes`, BadAsset if it's no file or reading fails
  [[nodiscard]] Result<std::string> read_file(std::string_view name, std::size_t max_bytes) const;

  /// The files and folders in the folder `name` ("": the root), sorted by name as bytes. What is neither, and links
  /// that leave or lead nowhere, are left out; dot files are not.
  /// @return NotFound, BadAsset if it can't be read
  [[nodiscard]] Result<std::vector<AssetEntry>> list_folder(std::string_view name) const;

  /// What `name` is, without reading it.
  /// @return NotFound, BadAsset if it's neither a regular file nor a folder
  [[nodiscard]] Result<AssetEntry> find(std::string_view name) const;

  /// Saves a new file, whole or not at all: nobody sees a part of it, and what fails leaves nothing behind. The folder it is to
  /// be in has to be there. The disk has it when this returns.
  /// @return Conflict where something of that name is there, NotFound for an unclean name or a missing folder, Unavailable
  ///         with the system's reason (a full disk, a folder that can't be written to)
  [[nodiscard]] Status save_file(std::string_view name, std::string_view bytes) const;

  /// Saves a new folder with these files in it, likewise.
  /// @param files  names without '/', none twice
  [[nodiscard]] Status save_folder(std::string_view name, std::span<const NewFile> files) const;

  /// Begins a new file or folder that takes a while to be made, with the same promises: it is there once it is committed.
  /// @return as save_file
  [[nodiscard]] Result<std::unique_ptr<NewAssetFile>> new_file(std::string_view name) const;
  [[nodiscard]] Result<std::unique_ptr<NewAssetFolder>> new_folder(std::string_view name) const;

  /// The folder as it was named to `open`.
  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }

 private:
  AssetRoot(std::string folder, Descriptor root) : folder_(std::move(folder)), root_(std::move(root)) {}
  [[nodiscard]] Result<Descriptor> open_name(std::string_view name, int flags) const;
  /// The folder that something called `name` is to be saved in.
  [[nodiscard]] Result<Descriptor> open_place(std::string_view name) const;
  /// The same, where there is nothing of that name yet.
  [[nodiscard]] Result<Descriptor> open_new_place(std::string_view name) const;

  std::string folder_;
  Descriptor root_;
};

}  // namespace tweend::assets
