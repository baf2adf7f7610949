#include "clients/cli/frame_lines.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "clients/cli/format.hpp"
#include "clients/cli/picture.hpp"

namespace tweend::cli {

std::string frame_size_text(const Packet& packet, const Json& layout) {
  const std::string asked = fmt::format("{} x {}", brief_member(layout, "width"), brief_member(layout, "height"));
  const auto size = picture_size(packet.payload);
  const std::string found = size ? fmt::format("{} x {}", size->width, size->height) : asked;
  return found == asked ? asked : fmt::format("{} of {}", found, asked);
}

std::string frame_json(const Packet& packet, ClockUs age_us, const std::string& file) {
  Json json = packet_json(packet, age_us);
  json["encoding"] = frame_encoding_name(packet.header);
  json["bytes"] = packet.header.payload_bytes;
  if (const auto size = picture_size(packet.payload)) {
    json["width"] = size->width;
    json["height"] = size->height;
  }
  if (!file.empty()) json["file"] = file;
  return to_line(json);
}

std::string frame_text(const Packet& packet, ClockUs age_us, const Json& layout) {
  return fmt::format("{}  {} {}, {}", packet_text(packet, age_us), frame_encoding_name(packet.header),
                     frame_size_text(packet, layout), bytes_text(packet.payload.size()));
}

}  // namespace tweend::cli
