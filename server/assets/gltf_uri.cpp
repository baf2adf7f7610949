#include "server/assets/gltf_uri.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <optional>

#include "server/assets/asset_name.hpp"

namespace tweend::assets {
namespace {

constexpr std::string_view kBase64Digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kNoDigit = 255;

constexpr std::array<std::uint8_t, 256> make_digit_values() {
  std::array<std::uint8_t, 256> values{};
  for (auto& value : values) value = kNoDigit;
  for (std::size_t i = 0; i < kBase64Digits.size(); ++i) {
    values[static_cast<std::uint8_t>(kBase64Digits[i])] = static_cast<std::uint8_t>(i);
  }
  return values;
}
constexpr std::array<std::uint8_t, 256> kDigitValues = make_digit_values();

bool is_letter(char c) noexcept { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

/// `http` of "http://host/file"; "" of a relative reference (RFC 3986, sections 3.1 and 4.2).
std::string_view scheme_of(std::string_view uri) noexcept {
  const std::size_t colon = uri.find_first_of(":/?#");
  if (colon == std::string_view::npos || uri[colon] != ':' || colon == 0 || !is_letter(uri.front())) return {};
  return uri.substr(0, colon);
}

/// Base64 (RFC 4648, section 4), padded or not. Nothing where it is none.
std::optional<std::string> decode_base64(std::string_view text) {
  if (text.size() % 4 == 0 && text.ends_with('=')) text.remove_suffix(text.ends_with("==") ? 2 : 1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  unsigned count = 0;
  for (const char c : text) {
    const std::uint8_t digit = kDigitValues[static_cast<std::uint8_t>(c)];
    if (digit == kNoDigit) return std::nullopt;
    bits = (bits << 6U) | digit;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count);
    bits &= (1U << count) - 1U;
  }
  if (bits != 0) return std::nullopt;  // bits that belong to no byte
  return bytes;
}

std::optional<std::uint8_t> hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return static_cast<std::uint8_t>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<std::uint8_t>(c - 'a' + 10);
  if (c >= 'A' && c <= 'F') return static_cast<std::uint8_t>(c - 'A' + 10);
  return std::nullopt;
}

/// With each %XX replaced by its byte. Nothing where a % has no two hexadecimal digits behind it.
std::optional<std::string> decode_percents(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    if (text.size() - i < 3) return std::nullopt;
    const auto high = hex_digit(text[i + 1]);
    const auto low = hex_digit(text[i + 2]);
    if (!high || !low) return std::nullopt;
    decoded += static_cast<char>(*high * 16 + *low);
    i += 2;
  }
  return decoded;
}

bool is_data(std::string_view scheme) noexcept {
  constexpr std::string_view kData = "data";
  return scheme.size() == kData.size() && has_extension(scheme, kData);
}

Result<std::string> decode_data(std::string_view uri, const JsonNode& node) {
  constexpr std::string_view kBase64 = ";base64";
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !has_extension(uri.substr(0, comma), kBase64)) {
    return node.expected("a data URI in base64, data:TYPE;base64,BYTES");
  }
  std::optional<std::string> bytes = decode_base64(uri.substr(comma + 1));
  if (!bytes) return node.error("expected base64 behind the comma of the data URI, found something else");
  return std::move(*bytes);
}

}  // namespace

Result<std::string> GltfUris::fetch(const JsonNode& uri) {
  TWEEND_ASSIGN(const std::string_view text, uri.text());
  const std::string_view scheme = scheme_of(text);
  if (is_data(scheme)) return decode_data(text, uri);
  if (!scheme.empty()) return uri.expected("a path relative to the file, or a data URI");
  const std::optional<std::string> reference = decode_percents(text);
  if (!reference) return uri.expected("a URI with two hexadecimal digits behind each %");
  const std::size_t slash = file_.rfind('/');
  const std::optional<std::string> name =
      resolve_name(slash == std::string::npos ? std::string() : file_.substr(0, slash), *reference);
  if (!name) return uri.expected("a path relative to the file that stays in the assets folder");
  auto bytes = read_(*name, bytes_left_);
  if (!bytes) {
    const bool limit = bytes.error().code == ErrorCode::Limit;
    return uri.error(bytes.error().message, limit ? ErrorCode::Limit : ErrorCode::BadAsset);
  }
  bytes_left_ -= bytes->size();
  return std::move(*bytes);
}

}  // namespace tweend::assets
