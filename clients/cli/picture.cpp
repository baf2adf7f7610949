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

[[noreturn]] void refuse(const protocol::PacketHeader& header, std::string_view expected) {
  throw NoServer(fmt::format("packet {}: expected a frame in {}, found kind {} in encoding {}", header.sequence, expected,
                             static_cast<int>(header.kind), header.encoding));
}

/// Big-endian.
std::uint32_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint32_t number = 0;
  for (const char byte : bytes.substr(at, size)) number = number << 8U | static_cast<unsigned char>(byte);
  return number;
}

PictureSize size_at(std::string_view bytes, std::size_t width_at, std::size_t height_at, std::size_t size) {
  return {number_at(bytes, width_at, size), number_at(bytes, height_at, size)};
}

/// The frame header, SOF0 to SOF15 less the three that are tables: a length, the precision, height and width.
bool is_frame_header(std::uint32_t marker) {
  return marker >= 0xFFC0 && marker <= 0xFFCF && marker != 0xFFC4 && marker != 0xFFC8 && marker != 0xFFCC;
}

std::optional<PictureSize> jpeg_size(std::string_view file) {
  constexpr std::size_t kHeader = 9;  // marker, length, precision, height, width
  for (std::size_t at = 2; at + kHeader <= file.size(); at += 2 + number_at(file, at + 2, 2)) {
    const std::uint32_t marker = number_at(file, at, 2);
    if (marker < 0xFF00) return std::nullopt;
    if (is_frame_header(marker)) return size_at(file, at + 7, at + 5, 2);
  }
  return std::nullopt;
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

PictureFormat picture_format(const protocol::PacketHeader& header) {
  if (header.kind == protocol::PacketKind::Frame && header.encoding < kKinds.size()) return kKinds[header.encoding].format;
  refuse(header, "jpeg or png");
}

std::string_view frame_encoding_name(const protocol::PacketHeader& header) {
  constexpr std::array kNames{"jpeg"sv, "png"sv, "h264"sv, "rgba"sv};
  if (header.kind == protocol::PacketKind::Frame && header.encoding < kNames.size()) return kNames[header.encoding];
  refuse(header, "jpeg, png, h264 or rgba");
}

void check_picture(std::string_view bytes, PictureFormat format, std::string_view source) {
  const Kind& kind = kind_of(format);
  if (bytes.starts_with(kind.first_bytes)) return;
  const std::string found =
      bytes.empty() ? "nothing" : fmt::format("{} bytes that start with {}", bytes.size(), hex(bytes.substr(0, 8)));
  throw NoServer(fmt::format("{} sent no {} picture: expected bytes that start with {}, found {}", source, kind.name,
                             hex(kind.first_bytes), found));
}

std::optional<PictureSize> picture_size(std::string_view file) {
  constexpr std::size_t kPngSize = 16;  // behind its signature, the length and name of the first chunk
  if (file.starts_with(kind_of(PictureFormat::Jpeg).first_bytes)) return jpeg_size(file);
  const bool is_png = file.starts_with(kind_of(PictureFormat::Png).first_bytes) && file.size() >= kPngSize + 8;
  if (!is_png) return std::nullopt;
  return size_at(file, kPngSize, kPngSize + 4, 4);
}

}  // namespace tweend::cli
