#pragma once

#include <nlohmann/json_fwd.hpp>

namespace tweend::cli {

/// Keeps the order of members, so that --json prints them as the server sent them.
/// Headers see only this declaration; units that look inside a value include <nlohmann/json.hpp>.
using Json = nlohmann::ordered_json;

}  // namespace tweend::cli
