#pragma once

#include <cstddef>
#include <string>

#include "server/base/result.hpp"

namespace tweend::app {

/// The name of picture `number` by a pattern with at most one `%d` or `%04d` (C's printf, width up to 9); `%%` is a percent
/// sign.
/// @return InvalidParams where the pattern has anything else behind a '%', or no number though there are several pictures
[[nodiscard]] Result<std::string> numbered_name(const std::string& pattern, std::size_t number, bool several);

}  // namespace tweend::app
