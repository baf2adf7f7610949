#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "protocol/packet.hpp"

namespace tweend::cli {

/// A kind of picture file that a server makes.
enum class PictureFormat : std::uint8_t { Jpeg, Png };

/// `jpeg` or `png`, as the protocol calls it.
[[nodiscard]] std::string_view name_of(PictureFormat format);
/// What its files end with: `.jpg` or `.png`.
[[nodiscard]] std::string_view extension_of(PictureFormat format);
/// By the extension of a file's name, in capitals or not; empty: another one.
[[nodiscard]] std::optional<PictureFormat> format_of_file(std::string_view name);
/// What file a packet holds. Throws NoServer, naming the packet, where it holds none.
[[nodiscard]] PictureFormat picture_format(const protocol::PacketHeader& header);
/// What a frame's encoding is called, `jpeg`; throws like picture_format() where the packet is none or has no such encoding.
[[nodiscard]] std::string_view frame_encoding_name(const protocol::PacketHeader& header);

/// Looks at the first bytes, so that nothing else is ever stored under a picture's name.
/// @param source  who sent it, for the message
/// Throws NoServer.
void check_picture(std::string_view bytes, PictureFormat format, std::string_view source);

struct PictureSize {
  std::uint32_t width;
  std::uint32_t height;
};
/// What a JPEG or PNG file says of itself; empty where it does not.
[[nodiscard]] std::optional<PictureSize> picture_size(std::string_view file);

}  // namespace tweend::cli
