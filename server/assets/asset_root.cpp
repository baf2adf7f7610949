#include "server/assets/asset_root.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "server/assets/asset_name.hpp"

namespace tweend::assets {
namespace {

constexpr std::size_t kReadBytes = 256U << 10U;

std::string errno_text(int error) { return std::generic_category().message(error); }

Error not_found(std::string_view name) {
  return fail(ErrorCode::NotFound,
              fmt::format("expected a file or folder under the assets folder, found no {}", quoted_name(name)));
}

Error unreadable(std::string_view name, int error) {
  return fail(ErrorCode::BadAsset, fmt::format("{} can't be read: {}", quoted_name(name), errno_text(error)));
}

Error open_error(std::string_view name, int error) {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
    case EXDEV:  // it would leave the folder
    case ELOOP:
    case ENAMETOOLONG:
      return not_found(name);
    default:
      return unreadable(name, error);
  }
}

Error too_long(std::string_view name, std::size_t max_bytes) {
  return fail(ErrorCode::Limit, fmt::format("expected at most {} bytes, found more in {}", max_bytes, quoted_name(name)));
}

/// What `status` describes, if it's a regular file or a folder.
std::optional<AssetEntry> entry_of(const struct stat& status, std::string_view name) {
  if (S_ISDIR(status.st_mode)) return AssetEntry{std::string(name), true, 0, false};
  if (!S_ISREG(status.st_mode)) return std::nullopt;
  return AssetEntry{std::string(name), false, static_cast<std::uint64_t>(status.st_size), false};
}

/// Describes `name`, an entry of the open folder `folder`; `path` is its way from `root`, which links need.
std::optional<AssetEntry> read_entry(int root, int folder, const char* name, const std::string& path) {
  struct stat status {};
  if (::fstatat(folder, name, &status, AT_SYMLINK_NOFOLLOW) != 0) return std::nullopt;
  if (!S_ISLNK(status.st_mode)) return entry_of(status, name);
  const Opened target = open_beneath(root, path, O_PATH);
  if (!target.descriptor.is_open() || ::fstat(target.descriptor.get(), &status) != 0) return std::nullopt;
  std::optional<AssetEntry> entry = entry_of(status, name);
  if (entry) entry->link = true;
  return entry;
}

/// Reads to the end, or to one byte past `max_bytes`. @return 0 or an errno
int read_up_to(int fd, std::size_t expected_bytes, std::size_t max_bytes, std::string& text) {
  std::size_t size = 0;
  text.resize(std::min(expected_bytes, max_bytes) + 1);  // a file as long as it says ends in one further read of 0
  while (size <= max_bytes) {
    if (size == text.size()) text.resize(size + kReadBytes);
    const ssize_t got = ::read(fd, text.data() + size, text.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno;
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  text.resize(size);
  return 0;
}

}  // namespace

Result<AssetRoot> AssetRoot::open(const std::string& folder) {
  Descriptor root(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!root.is_open()) {
    const std::string reason = errno_text(errno);
    return fail(ErrorCode::NotFound, fmt::format("the assets folder \"{}\" can't be opened: {}", folder, reason));
  }
  return AssetRoot(folder, std::move(root));
}

Result<Descriptor> AssetRoot::open_name(std::string_view name, int flags) const {
  if (!is_clean_name(name)) return not_found(name);
  Opened opened = open_beneath(root_.get(), std::string(name), flags);
  if (!opened.descriptor.is_open()) return open_error(name, opened.error);
  return std::move(opened.descriptor);
}

Result<AssetEntry> AssetRoot::find(std::string_view name) const {
  TWEEND_ASSIGN(const Descriptor file, open_name(name, O_PATH));
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return unreadable(name, errno);
  std::optional<AssetEntry> entry = entry_of(status, name);
  if (!entry)
    return fail(ErrorCode::BadAsset, fmt::format("expected a file or folder, found {} to be neither", quoted_name(name)));
  return std::move(*entry);
}

Result<std::string> AssetRoot::read_file(std::string_view name, std::size_t max_bytes) const {
  // A look first: merely opening some devices does something, and a socket can't be opened at all.
  TWEEND_ASSIGN(const AssetEntry entry, find(name));
  if (entry.directory)
    return fail(ErrorCode::BadAsset, fmt::format("expected a file, found {} to be a folder", quoted_name(name)));
  // Whoever puts a pipe in the file's place now doesn't make us wait for its writer.
  TWEEND_ASSIGN(const Descriptor file, open_name(name, O_RDONLY | O_NONBLOCK | O_NOCTTY));
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return unreadable(name, errno);
  if (!S_ISREG(status.st_mode)) {
    return fail(ErrorCode::BadAsset, fmt::format("expected a regular file, found {} to be none", quoted_name(name)));
  }
  const auto bytes = static_cast<std::uint64_t>(status.st_size);
  if (bytes > max_bytes) return too_long(name, max_bytes);
  std::string text;
  if (const int error = read_up_to(file.get(), static_cast<std::size_t>(bytes), max_bytes, text); error != 0) {
    return unreadable(name, error);
  }
  if (text.size() > max_bytes) return too_long(name, max_bytes);
  return text;
}

Result<std::vector<AssetEntry>> AssetRoot::list_folder(std::string_view name) const {
  constexpr int kFlags = O_RDONLY | O_DIRECTORY;
  Opened opened;
  if (name.empty()) {
    opened = open_beneath(root_.get(), ".", kFlags);
    if (!opened.descriptor.is_open()) return unreadable(folder_, opened.error);
  } else {
    TWEEND_ASSIGN(opened.descriptor, open_name(name, kFlags));
  }
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(::fdopendir(opened.descriptor.get()), &::closedir);
  if (folder == nullptr) return unreadable(name, errno);
  const int fd = opened.descriptor.release();  // closedir closes it from here on
  std::vector<AssetEntry> entries;
  errno = 0;
  while (const dirent* found = ::readdir(folder.get())) {
    const std::string_view entry_name = found->d_name;
    if (entry_name != "." && entry_name != "..") {
      auto entry = read_entry(root_.get(), fd, found->d_name, join_name(name, entry_name));
      if (entry) entries.push_back(std::move(*entry));
    }
    errno = 0;  // tells readdir's end from its failure
  }
  if (errno != 0) return unreadable(name, errno);
  std::sort(entries.begin(), entries.end(), [](const AssetEntry& a, const AssetEntry& b) { return a.name < b.name; });
  return entries;
}

}  // namespace tweend::assets
