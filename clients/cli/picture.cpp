#include "clients/cli/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include "clients/cli/failure.hpp"

namespace tweend::cli {
namespace {

using namespace std::string_view_literals;

struct Kind {
  PictureFormat format;
  std::string_view name;
  std::string_view extension;
  std::string_view first_bytes;
};

// In the order of the numbers that packets have for them (docs/PROTOCOL.md, section 6).
constexpr std::array kKinds{Kind{PictureFormat::Jpeg, "jpeg", ".jpg", "\xFF\xD8\xFF"sv},
                            Kind{PictureFormat::Png, "png", ".png", "\x89PNG\r\n\x1A\n"sv}};

const Kind& kind_of(PictureFormat format) { return kKinds[static_cast<std::size_t>(format)]; }

std::string hex(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes) text += fmt::format("{}{:02x}", text.empty() ? "" : " ", static_cast<unsigned char>(byte));
  return text;
}

}  // namespace

std::string_view name_of(PictureFormat format) { return kind_of(format).name; }

std::string_view extension_of(PictureFormat format) { return kind_of(format).extension; }

std::optional<PictureFormat> format_of_file(std::string_view name) {
  std::string extension(name.substr(std::min(name.rfind('.'), name.size())));
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".jpeg") return PictureFormat::Jpeg;
  for (const Kind& kind : kKinds) {
    if (extension == kind.extension) return kind.format;
  }
  return std::nullopt;
}

std::optional<PictureFormat> format_of_packet(std::uint8_t encoding) {
  if (encoding >= kKinds.size()) return std::nullopt;
  return kKinds[encoding].format;
}

void check_picture(std::string_view bytes, PictureFormat format, std::string_view source) {
  const Kind& kind = kind_of(format);
  if (bytes.starts_with(kind.first_bytes)) return;
  const std::string found =
      bytes.empty() ? "nothing" : fmt::format("{} bytes that start with {}", bytes.size(), hex(bytes.substr(0, 8)));
  throw NoServer(fmt::format("{} sent no {} picture: expected bytes that start with {}, found {}", source, kind.name,
                             hex(kind.first_bytes), found));
}

}  // namespace tweend::cli
