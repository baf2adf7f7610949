#pragma once

namespace tweend::app {

/// Prints what draws, every way that was tried and why it was not taken, and whether the page was found.
/// @return the process's exit code: 0 if pictures can be drawn, else 1
[[nodiscard]] int doctor();

}  // namespace tweend::app
