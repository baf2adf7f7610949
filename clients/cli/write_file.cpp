#include "clients/cli/write_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "clients/cli/failure.hpp"
#include "clients/cli/format.hpp"

namespace tweend::cli {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

/// Hidden, and in the same folder: a file can't be renamed into another file system.
std::string temporary_beside(const std::filesystem::path& path) {
  return (path.parent_path() / fmt::format(".{}.{}", path.filename().string(), getpid())).string();
}

bool write_all(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// @return 0, or the errno of what failed
int write_beside(const std::string& path, const std::string& temporary, std::string_view content) {
  constexpr mode_t kMode = 0666;  // less the umask, as for any file that a program makes
  const int file = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, kMode);
  if (file < 0) return errno;
  int error = write_all(file, content) ? 0 : errno;
  if (close(file) != 0 && error == 0) error = errno;  // a full disk may be told only here
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) unlink(temporary.c_str());
  return error;
}

}  // namespace

void write_file(const std::string& path, std::string_view content) {
  if (const int error = write_beside(path, temporary_beside(path), content); error != 0) {
    throw Failure(ExitCode::Refused, fmt::format("can't write {}: expected a place for {}, found: {}", path,
                                                 bytes_text(content.size()), reason(error)));
  }
}

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!error && !std::filesystem::is_directory(path, error)) error = std::make_error_code(std::errc::not_a_directory);
  if (!error && access(path.c_str(), W_OK | X_OK) != 0) error = {errno, std::generic_category()};
  if (error) {
    throw Usage(fmt::format("can't make the folder {}: expected one, or a place for it, found: {}", path, error.message()));
  }
}

}  // namespace tweend::cli
