#pragma once

#include <string>

#include "server/base/limits.hpp"
#include "server/base/result.hpp"

namespace tweend::app {

/// What `tweend inspect` was asked for.
struct InspectOptions {
  std::string path;  ///< of a .glb, .gltf or .obj file, or of a sequence's folder
  Limits limits;
};

/// What the file holds, in lines for people. It is read as an asset of the folder it lies in, and reads nothing outside of it.
/// @return NotFound, or why it can't be imported
[[nodiscard]] Result<std::string> inspect_asset(const InspectOptions& options);

/// Prints it. @return the process's exit code: 0 done, 1 there is something wrong with the file, which was said
[[nodiscard]] int inspect(const InspectOptions& options);

}  // namespace tweend::app
