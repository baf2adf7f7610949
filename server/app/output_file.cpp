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

constexpr mode_t kMode = 0666;  // what the process's mask leaves of it

Error not_written(const std::string& path, int error) {
  return fail(ErrorCode::Unavailable, fmt::format("expected a file that can be written at {}, found: {}", path,
                                                  std::generic_category().message(error)));
}

}  // namespace

Result<std::unique_ptr<OutputFile>> OutputFile::open(const std::string& path) {
  const std::filesystem::path whole(path);
  const std::string folder = whole.has_parent_path() ? whole.parent_path().string() : ".";
  if (!whole.has_filename() || std::filesystem::is_directory(whole)) return not_written(path, EISDIR);
  std::string hidden = (std::filesystem::path(folder) / assets::hidden_name()).string();
  assets::Descriptor file(::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, kMode));
  const bool named = !file.is_open();
  if (named) file = assets::Descriptor(::open(hidden.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode));
  if (!file.is_open()) return not_written(path, errno);
  return std::unique_ptr<OutputFile>(new OutputFile(path, std::move(hidden), std::move(file), named));
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
    const std::string own = fmt::format("/proc/self/fd/{}", file_.get());
    if (::linkat(AT_FDCWD, own.c_str(), AT_FDCWD, hidden_.c_str(), AT_SYMLINK_FOLLOW) != 0) return not_written(path_, errno);
    named_ = true;
  }
  if (::rename(hidden_.c_str(), path_.c_str()) != 0) return not_written(path_, errno);
  named_ = false;
  return {};
}

}  // namespace tweend::app
