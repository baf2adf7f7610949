#include "server/assets/asset_name.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace tweend::assets {
namespace {

constexpr std::size_t kQuotedBytes = 200;
constexpr std::size_t kMaxReferenceBytes = 4'096;  // Linux opens no longer path

/// Bytes of the UTF-8 character that `text` begins with; 0 if it begins with none.
std::size_t utf8_character(std::string_view text) noexcept {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t size = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < size) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  const std::uint8_t second = byte(1);
  const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool surrogate = lead == 0xED && second > 0x9F;
  const bool past_unicode = lead == 0xF4 && second > 0x8F;
  return overlong || surrogate || past_unicode ? 0 : size;
}

bool is_clean_text(std::string_view text) noexcept {
  while (!text.empty()) {
    const std::size_t size = utf8_character(text);
    const auto byte = static_cast<std::uint8_t>(text.front());
    if (size == 0 || byte < 0x20 || byte == 0x7F || byte == '\\') return false;
    text.remove_prefix(size);
  }
  return true;
}

bool is_absolute(std::string_view reference) noexcept {
  return reference.starts_with('/') || reference.starts_with('\\') || (reference.size() > 1 && reference[1] == ':');
}

char lower(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

bool is_clean_name(std::string_view name) noexcept {
  if (!is_clean_text(name)) return false;
  for (;;) {
    const std::size_t slash = name.find('/');
    const std::string_view component = name.substr(0, slash);
    if (component.empty() || component == "." || component == "..") return false;
    if (slash == std::string_view::npos) return true;
    name.remove_prefix(slash + 1);
  }
}

bool has_extension(std::string_view name, std::string_view extension) noexcept {
  if (name.size() < extension.size()) return false;
  const std::string_view end = name.substr(name.size() - extension.size());
  return std::equal(end.begin(), end.end(), extension.begin(), [](char a, char b) { return lower(a) == b; });
}

bool is_gltf_name(std::string_view name) noexcept { return has_extension(name, ".glb") || has_extension(name, ".gltf"); }

std::string join_name(std::string_view folder, std::string_view name) {
  std::string path(folder);
  if (!path.empty()) path += '/';
  return path += name;
}

std::optional<std::string> resolve_name(std::string_view folder, std::string_view reference) {
  if (is_absolute(reference) || reference.size() > kMaxReferenceBytes) return std::nullopt;
  std::string path(folder);
  for (;;) {
    const std::size_t slash = reference.find_first_of("/\\");
    const std::string_view component = reference.substr(0, slash);
    if (component == "..") {
      if (path.empty()) return std::nullopt;
      const std::size_t parent = path.rfind('/');
      path.resize(parent == std::string::npos ? 0 : parent);
    } else if (!component.empty() && component != ".") {
      path = join_name(path, component);
    }
    if (slash == std::string_view::npos) break;
    reference.remove_prefix(slash + 1);
  }
  if (!is_clean_name(path)) return std::nullopt;
  return path;
}

std::string quoted_name(std::string_view name) {
  if (name.size() <= kQuotedBytes) return '"' + std::string(name) + '"';
  std::size_t end = kQuotedBytes;
  while (end > 0 && (static_cast<std::uint8_t>(name[end]) & 0xC0U) == 0x80U) --end;
  return '"' + std::string(name.substr(0, end)) + "…\"";
}

}  // namespace tweend::assets
