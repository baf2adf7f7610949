#pragma once

#include <string_view>

namespace tweend::log {

/// One line on standard error with time and level; safe from any thread.
/// Libraries return errors; only what nobody waits for (a listener's accept, a signal) is logged.
void info(std::string_view line);
void warn(std::string_view line);

}  // namespace tweend::log
