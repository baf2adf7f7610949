#pragma once

#include <string>

#include "server/base/result.hpp"

namespace tweend::app {

/// An asset by its path: the folder it lies in is an assets folder, the rest its name.
struct AssetPath {
  std::string folder;
  std::string name;
};

/// @param path  of a file or a sequence's folder
/// @return NotFound naming it and the system's reason
[[nodiscard]] Result<AssetPath> locate_asset(const std::string& path);

}  // namespace tweend::app
