#pragma once

#include <string>
#include <string_view>

#include "server/assets/gltf_reader.hpp"
#include "server/model/model.hpp"

namespace tweend::app {

/// What a glTF file lists, in lines for people.
[[nodiscard]] std::string report_facts(const assets::GltfFacts& facts);

/// What an import came to, in lines for people: joints, mesh, materials, skin, morph targets, clips, warnings.
[[nodiscard]] std::string report_model(const model::ImportedModel& imported);

/// A file's text without what would move a terminal's cursor: control characters become '?'.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace tweend::app
