#pragma once

#include "clients/cli/command.hpp"

namespace tweend::cli {

/// The array in a result that a list command shows.
using Pick = Json (*)(const Json& result);

/// Makes `command` send `method` and list what `pick` finds: as a table, as bare names (the member `name` of each) with
/// --names, or with --json the whole result.
void lists(Command& command, const char* method, Pick pick, const char* name, const char* when_empty);

}  // namespace tweend::cli
