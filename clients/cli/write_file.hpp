#pragma once

#include <string>
#include <string_view>

namespace tweend::cli {

/// Writes a whole file, in place of one that may be there. Whoever reads it sees the old content or all of the new:
/// it is written beside it and then given its name. Throws Failure with ExitCode::Refused, and then nothing is left behind.
void write_file(const std::string& path, std::string_view content);

/// Makes a folder with those above it, unless it is there, for files to be written in. Throws Usage.
void make_folder(const std::string& path);

}  // namespace tweend::cli
