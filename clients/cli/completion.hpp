#pragma once

#include <string>
#include <vector>

#include "clients/cli/outline.hpp"

namespace tweend::cli {

/// A bash script that completes the program's command line: commands, options and words from the outline, so that it can't
/// drift from what the program takes; names of things from the server, asked when Tab is pressed.
[[nodiscard]] std::string bash_completion(const std::vector<Outline>& outlines);

}  // namespace tweend::cli
