#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tweend::assets {

/// The number that the whole of `token` spells in decimal, e.g. "-1.5", "+.5", "2e-3": none of "nan", "0x10", "1,5".
/// One too large for a float is none, one too small becomes 0; below a double's range (1e-400) it is none as well.
[[nodiscard]] std::optional<float> parse_number(std::string_view token) noexcept;

/// The integer that the whole of `token` spells in decimal, with a '-' or no sign.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view token) noexcept;

/// `token` in quotation marks for a message: other than printable ASCII as \xNN, and cut if it's long.
[[nodiscard]] std::string quoted_token(std::string_view token);

}  // namespace tweend::assets
