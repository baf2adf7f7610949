#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "server/assets/new_file.hpp"
#include "server/assets/open_beneath.hpp"
#include "server/base/error.hpp"

namespace tweend::assets {

// New files and folders in an open folder. They are made under a name that begins with a dot, which no listing shows, and get
// their own when they are whole and on the disk. What goes wrong is told as an errno; then nothing is left behind.
// Safe from any thread, and against others who make the same name meanwhile: one of them wins.

/// @param folder  a descriptor that may be only a path (O_PATH)
/// @param name    without '/'
/// @return 0, or EEXIST where there is something of that name, or what the system said
[[nodiscard]] int save_file_in(int folder, const std::string& name, std::string_view bytes);
[[nodiscard]] int save_folder_in(int folder, const std::string& name, std::span<const NewFile> files);

/// Gives `from` in `folder` the name `to`, unless that is taken (EEXIST).
[[nodiscard]] int rename_new(int folder, const std::string& from, const std::string& to, bool is_folder);
/// The same where the file system can't (NFS): `to` is taken by something empty first, which is replaced then. Should the
/// machine stop between the two, the empty thing stays.
[[nodiscard]] int rename_over_placeholder(int folder, const std::string& from, const std::string& to, bool is_folder);

// The steps of it, for what is saved piece by piece:

/// A name that begins with a dot, and that nothing else has.
[[nodiscard]] std::string hidden_name();
/// Makes and opens a file of that name, which may not be there yet.
[[nodiscard]] Opened create_in(int folder, const std::string& name);
[[nodiscard]] Opened create_folder_in(int folder, const std::string& name);
/// Writes all of it at a place of a file.
[[nodiscard]] int write_all_at(int file, std::uint64_t offset, std::span<const std::byte> bytes);
/// So that a new name outlives a loss of power, as far as the file system knows how to.
void sync_folder(int folder);

/// What is answered for an errno of these.
[[nodiscard]] Error not_saved(std::string_view name, int error);
/// What `a/b/c` is called in its folder.
[[nodiscard]] inline std::string_view last_component(std::string_view name) { return name.substr(name.rfind('/') + 1); }

}  // namespace tweend::assets
