#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "protocol/packet.hpp"

namespace tweend::net {

/// How messages and packets are delimited on a connection.
enum class Framing : std::uint8_t {
  Line,       ///< text and '\n'; a packet behind the line that announces it
  WebSocket,  ///< RFC 6455 frames, unmasked: text messages and binary packets
  Multipart,  ///< RFC 2046 parts of an HTTP answer, one a picture; there is no place for messages, which are dropped
};

/// What stands between the parts of a Multipart answer.
#define TWEEND_BOUNDARY "tweend-frame"
inline constexpr std::string_view kMultipartType = "multipart/x-mixed-replace; boundary=" TWEEND_BOUNDARY;
inline constexpr std::string_view kMultipartBegin = "--" TWEEND_BOUNDARY "\r\n";
inline constexpr std::string_view kMultipartNext = "\r\n--" TWEEND_BOUNDARY "\r\n";
#undef TWEEND_BOUNDARY

/// No message has more than this in front of its body.
inline constexpr std::size_t kMostPrefixBytes = 160;

/// What goes before a text of so many bytes, and after it.
/// @param out  room for kMostPrefixBytes
/// @return bytes written
std::size_t write_text_prefix(Framing framing, std::size_t body_bytes, char* out) noexcept;
[[nodiscard]] std::string_view text_suffix(Framing framing) noexcept;

/// What goes before the payload of a packet, its header included, and after it.
/// @param out  room for kMostPrefixBytes
/// @return bytes written
std::size_t write_packet_prefix(Framing framing, const protocol::PacketHeader& header, char* out) noexcept;
[[nodiscard]] std::string_view packet_suffix(Framing framing) noexcept;

/// A whole close frame of RFC 6455, section 5.5.1, for the client of a WebSocket.
/// @param reason  UTF-8; more than the 123 bytes that there is room for are cut off
[[nodiscard]] std::string close_frame(std::uint16_t code, std::string_view reason);

}  // namespace tweend::net
