#include "server/app/asset_path.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace tweend::app {

Result<AssetPath> locate_asset(const std::string& path) {
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::canonical(path, error);
  if (error || !whole.has_filename()) {
    return fail(ErrorCode::NotFound,
                fmt::format("expected a file or a folder at {}, found: {}", path, error ? error.message() : "the root folder"));
  }
  return AssetPath{whole.parent_path().string(), whole.filename().string()};
}

}  // namespace tweend::app
