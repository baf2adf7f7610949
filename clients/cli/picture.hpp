#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace tweend::cli {

/// A kind of picture file that a server makes.
enum class PictureFormat : std::uint8_t { Jpeg, Png };

/// `jpeg` or `png`, as the protocol calls it.
[[nodiscard]] std::string_view name_of(PictureFormat format);
/// What its files end with: `.jpg` or `.png`.
[[nodiscard]] std::string_view extension_of(PictureFormat format);
/// By the extension of a file's name, in capitals or not; empty: another one.
[[nodiscard]] std::optional<PictureFormat> format_of_file(std::string_view name);
/// By PacketHeader::encoding of a frame; empty: a packet that holds no picture file.
[[nodiscard]] std::optional<PictureFormat> format_of_packet(std::uint8_t encoding);

/// Looks at the first bytes, so that nothing else is ever stored under a picture's name.
/// @param source  who sent it, for the message
/// Throws NoServer.
void check_picture(std::string_view bytes, PictureFormat format, std::string_view source);

}  // namespace tweend::cli
