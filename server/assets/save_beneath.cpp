#include "server/assets/save_beneath.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <random>
#include <system_error>
#include <utility>

#include "server/assets/asset_name.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {
namespace {

constexpr mode_t kFileMode = 0666;  // what the process's mask leaves of it
constexpr mode_t kFolderMode = 0777;

int result_of(int returned) { return returned == 0 ? 0 : errno; }

/// What fails leaves the file, for the caller to remove.
int write_new(int folder, const std::string& name, std::string_view bytes) {
  const Opened file = create_in(folder, name);
  if (!file.descriptor.is_open()) return file.error;
  const int error = write_all_at(file.descriptor.get(), 0, std::as_bytes(std::span(bytes)));
  return error != 0 ? error : result_of(::fsync(file.descriptor.get()));
}

int write_folder(int parent, const std::string& name, std::span<const NewFile> files) {
  const Descriptor folder(::openat(parent, name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  if (!folder.is_open()) return errno;
  for (const NewFile& file : files) {
    if (const int error = write_new(folder.get(), file.name, file.bytes); error != 0) return error;
  }
  return result_of(::fsync(folder.get()));
}

void remove_folder(int parent, const std::string& name, std::span<const NewFile> files) {
  {
    const Descriptor folder(::openat(parent, name.c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    for (const NewFile& file : files) {
      if (folder.is_open()) static_cast<void>(::unlinkat(folder.get(), file.name.c_str(), 0));
    }
  }
  static_cast<void>(::unlinkat(parent, name.c_str(), AT_REMOVEDIR));
}

}  // namespace

std::string hidden_name() {
  std::random_device random;
  const std::uint64_t number = (std::uint64_t{random()} << 32U) | random();
  return fmt::format(".tweend-{:016x}", number);
}

Opened create_in(int folder, const std::string& name) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  Descriptor file(::openat(folder, name.c_str(), kFlags, kFileMode));
  const int error = file.is_open() ? 0 : errno;
  return {std::move(file), error};
}

Opened create_folder_in(int folder, const std::string& name) {
  if (::mkdirat(folder, name.c_str(), kFolderMode) != 0) return {Descriptor(), errno};
  Descriptor made(::openat(folder, name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  const int error = made.is_open() ? 0 : errno;
  if (error != 0) static_cast<void>(::unlinkat(folder, name.c_str(), AT_REMOVEDIR));
  return {std::move(made), error};
}

int write_all_at(int file, std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(file, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
  return 0;
}

void sync_folder(int folder) {
  const Descriptor readable(::openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (readable.is_open()) static_cast<void>(::fsync(readable.get()));
}

Error not_saved(std::string_view name, int error) {
  const std::string quoted = quoted_name(name);
  switch (error) {
    case EEXIST:
    case ENOTEMPTY:
      return fail(ErrorCode::Conflict, fmt::format("expected a new name under the assets folder, found that there is a {} "
                                                   "already: choose another, or remove that one",
                                                   quoted));
    case ENAMETOOLONG:
      return fail(ErrorCode::InvalidParams, fmt::format("expected a name that the disk can hold, found {}", quoted));
    default:
      return fail(ErrorCode::Unavailable,
                  fmt::format("{} can't be saved: {}; nothing of it is left", quoted, std::generic_category().message(error)));
  }
}

int rename_new(int folder, const std::string& from, const std::string& to, bool is_folder) {
  const int error = result_of(::renameat2(folder, from.c_str(), folder, to.c_str(), RENAME_NOREPLACE));
  if (error != EINVAL && error != ENOSYS) return error;
  return rename_over_placeholder(folder, from, to, is_folder);
}

int rename_over_placeholder(int folder, const std::string& from, const std::string& to, bool is_folder) {
  const int taken = is_folder ? result_of(::mkdirat(folder, to.c_str(), kFolderMode)) : write_new(folder, to, {});
  if (taken != 0) return taken;
  const int error = result_of(::renameat(folder, from.c_str(), folder, to.c_str()));
  if (error != 0) static_cast<void>(::unlinkat(folder, to.c_str(), is_folder ? AT_REMOVEDIR : 0));
  return error;
}

int save_file_in(int folder, const std::string& name, std::string_view bytes) {
  const std::string hidden = hidden_name();
  int error = write_new(folder, hidden, bytes);
  if (error == EEXIST) return EAGAIN;  // of 2^64 names just this one: it is not ours to remove
  if (error == 0) error = rename_new(folder, hidden, name, false);
  if (error != 0) static_cast<void>(::unlinkat(folder, hidden.c_str(), 0));
  if (error == 0) sync_folder(folder);
  return error;
}

int save_folder_in(int folder, const std::string& name, std::span<const NewFile> files) {
  const std::string hidden = hidden_name();
  int error = result_of(::mkdirat(folder, hidden.c_str(), kFolderMode));
  if (error != 0) return error == EEXIST ? EAGAIN : error;
  error = write_folder(folder, hidden, files);
  if (error == 0) error = rename_new(folder, hidden, name, true);
  if (error != 0) remove_folder(folder, hidden, files);
  if (error == 0) sync_folder(folder);
  return error;
}

}  // namespace tweend::assets
