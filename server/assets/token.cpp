#include "server/assets/token.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <system_error>

namespace tweend::assets {
namespace {

constexpr std::size_t kQuotedBytes = 40;

}  // namespace

std::optional<float> parse_number(std::string_view token) noexcept {
  if (!token.empty() && token.front() == '+') {
    token.remove_prefix(1);
    if (!token.empty() && token.front() == '-') return std::nullopt;
  }
  // As a double first: from_chars calls a float too small for its range an error.
  double number = 0.0;
  const char* const end = token.data() + token.size();
  const auto [rest, error] = std::from_chars(token.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  // Also false for NaN; and a double past the range of float may not be converted at all.
  if (!(std::abs(number) <= static_cast<double>(std::numeric_limits<float>::max()))) return std::nullopt;
  return static_cast<float>(number);
}

std::optional<std::int64_t> parse_integer(std::string_view token) noexcept {
  std::int64_t number = 0;
  const char* const end = token.data() + token.size();
  const auto [rest, error] = std::from_chars(token.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  return number;
}

std::string quoted_token(std::string_view token) {
  std::string text = "\"";
  for (const char c : token.substr(0, kQuotedBytes)) {
    if (c >= ' ' && c <= '~') {
      text += c;
    } else {
      fmt::format_to(std::back_inserter(text), "\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
  return text += token.size() > kQuotedBytes ? "...\"" : "\"";
}

}  // namespace tweend::assets
