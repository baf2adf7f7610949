#include "server/app/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "server/assets/save_beneath.hpp"

namespace tweend::app {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kMode = 0666;  // what the process's mask leaves of it

Error not_written(const std::string& path, const std::string& found) {
  return fail(ErrorCode::Unavailable, fmt::format("expected a file that can be written at {}, found: {}", path, found));
}

Error not_written(const std::string& path, int error) {
  return not_written(path, std::generic_category().message(error) + "; choose another place");
}

/// What an open file is called while it has no name.
std::string own_path(const assets::Descriptor& file) { return fmt::format("/proc/self/fd/{}", file.get()); }

/// Where a path leads through the links it ends with, there or not: they stay, and what they name is replaced.
fs::path behind_links(fs::path path, std::error_code& error) {
  constexpr int kMost = 40;  // as the kernel's
  for (int links = 0; links < kMost; ++links) {
    const fs::file_type type = fs::symlink_status(path, error).type();
    // What is not there yet is no error.
    if (type == fs::file_type::not_found) error.clear();
    if (error || type != fs::file_type::symlink) return path;
    const fs::path to = fs::read_symlink(path, error);
    if (error) return path;
    path = path.parent_path() / to;
  }
  error = std::make_error_code(std::errc::too_many_symbolic_link_levels);
  return path;
}

}  // namespace

Result<std::unique_ptr<OutputFile>> OutputFile::open(const std::string& path) {
  std::error_code error;
  const fs::path whole = behind_links(path, error);
  if (error) return not_written(path, error.value());
  const fs::file_type type = fs::symlink_status(whole, error).type();
  if (!whole.has_filename() || type == fs::file_type::directory) return not_written(path, EISDIR);
  if (type != fs::file_type::not_found && type != fs::file_type::regular)
    return not_written(path, "something that is no regular file; choose another name");
  const std::string folder = whole.has_parent_path() ? whole.parent_path().string() : ".";
  std::string hidden = (fs::path(folder) / assets::hidden_name()).string();
  assets::Descriptor file(::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, kMode));
  // What has no name gets it through /proc, where that is mounted.
  const bool named = !file.is_open() || ::access(own_path(file).c_str(), F_OK) != 0;
  if (named) file = assets::Descriptor(::open(hidden.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode));
  if (file.is_open())
    return std::unique_ptr<OutputFile>(new OutputFile(whole.string(), std::move(hidden), std::move(file), named));
  if (errno != ENOENT) return not_written(path, errno);
  return not_written(path, fmt::format("No such file or directory; make the folder {} first", folder));
}

OutputFile::~OutputFile() {
  if (named_) static_cast<void>(::unlink(hidden_.c_str()));
}

Status OutputFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  const int error = assets::write_all_at(file_.get(), offset, bytes);
  if (error != 0) return not_written(path_, error);
  return {};
}

Status OutputFile::commit() {
  if (!named_) {
    if (::linkat(AT_FDCWD, own_path(file_).c_str(), AT_FDCWD, hidden_.c_str(), AT_SYMLINK_FOLLOW) != 0)
      return not_written(path_, errno);
    named_ = true;
  }
  if (::rename(hidden_.c_str(), path_.c_str()) != 0) return not_written(path_, errno);
  named_ = false;
  return {};
}

}  // namespace tweend::app
