#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/base/result.hpp"

namespace tweend::protocol {

/// RFC 4648 section 4, with padding. Appends to `out`.
void append_base64(std::span<const std::byte> bytes, std::string& out);

/// @return InvalidParams naming the length or the first character that is not base64; padding may not be left out
[[nodiscard]] Result<std::vector<std::byte>> decode_base64(std::string_view text);

}  // namespace tweend::protocol
