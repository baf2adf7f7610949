#pragma once

#include <optional>
#include <string>

#include "server/base/result.hpp"
#include "server/commands/command.hpp"

namespace tweend::commands {

/// The actor as a .glb file: what `asset.export` saves, and GET /scenes/{scene}/actors/{actor}.glb answers. On a worker.
/// @return NotFound for a scene or an actor that is not there; what assets::write_glb returns
[[nodiscard]] Result<std::string> exported_glb(const std::string& scene, const std::string& actor, const QueryContext& context);

/// Whether something may be saved under this name: parts of A-Z a-z 0-9 _ . - with '/' between, none of them longer than 64 or
/// beginning with a dot.
/// @return NotFound for one that leaves the assets folder, else InvalidParams; path "params.name"
[[nodiscard]] Status check_new_name(const std::string& name);
/// The same, of a .glb file or of a folder.
[[nodiscard]] Status check_export_name(const std::string& name, bool is_glb);

}  // namespace tweend::commands
