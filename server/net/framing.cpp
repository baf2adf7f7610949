#include "server/net/framing.hpp"

#include <charconv>
#include <cstring>

namespace tweend::net {
namespace {

constexpr unsigned char kTextFrame = 0x81;    // FIN, opcode 1
constexpr unsigned char kBinaryFrame = 0x82;  // FIN, opcode 2
constexpr unsigned char kCloseFrame = 0x88;   // FIN, opcode 8
constexpr std::size_t kMostReasonBytes = 123;

char* put(std::string_view text, char* out) noexcept {
  std::memcpy(out, text.data(), text.size());
  return out + text.size();
}

char* put(std::uint64_t number, char* out) noexcept {
  constexpr std::size_t kMostDigits = 20;
  return std::to_chars(out, out + kMostDigits, number).ptr;
}

/// RFC 6455, section 5.2: an unmasked frame's header.
char* put_frame_header(unsigned char first, std::size_t bytes, char* out) noexcept {
  out[0] = static_cast<char>(first);
  const std::size_t size_bytes = bytes < 126 ? 0 : bytes <= 0xFFFF ? 2 : 8;
  out[1] = static_cast<char>(size_bytes == 0 ? bytes : size_bytes == 2 ? 126 : 127);
  for (std::size_t i = 0; i < size_bytes; ++i) out[2 + i] = static_cast<char>((bytes >> (8 * (size_bytes - 1 - i))) & 0xFFU);
  return out + 2 + size_bytes;
}

}  // namespace

std::size_t write_text_prefix(Framing framing, std::size_t body_bytes, char* out) noexcept {
  return framing == Framing::WebSocket ? static_cast<std::size_t>(put_frame_header(kTextFrame, body_bytes, out) - out) : 0;
}

std::string_view text_suffix(Framing framing) noexcept { return framing == Framing::Line ? "\n" : ""; }

std::size_t write_packet_prefix(Framing framing, const protocol::PacketHeader& header, char* out) noexcept {
  char* at = out;
  if (framing == Framing::Multipart) {
    at = put("Content-Type: image/jpeg\r\nContent-Length: ", at);
    at = put(header.payload_bytes, at);
    at = put("\r\n\r\n", at);
    return static_cast<std::size_t>(at - out);
  }
  const std::size_t bytes = protocol::kPacketHeaderBytes + header.payload_bytes;
  if (framing == Framing::Line) {
    at = put(R"({"jsonrpc":"2.0","method":"stream.packet","params":{"stream":)", at);
    at = put(header.stream, at);
    at = put(R"(,"bytes":)", at);
    at = put(bytes, at);
    at = put("}}\n", at);
  } else {
    at = put_frame_header(kBinaryFrame, bytes, at);
  }
  const protocol::PacketHeaderBytes encoded = protocol::encode_header(header);
  std::memcpy(at, encoded.data(), encoded.size());
  return static_cast<std::size_t>(at - out) + encoded.size();
}

/// The boundary stands behind each part, not before: a browser shows a picture when it sees the next boundary.
std::string_view packet_suffix(Framing framing) noexcept { return framing == Framing::Multipart ? kMultipartNext : ""; }

std::string close_frame(std::uint16_t code, std::string_view reason) {
  reason = reason.substr(0, kMostReasonBytes);
  std::string frame{static_cast<char>(kCloseFrame), static_cast<char>(2 + reason.size()), static_cast<char>(code >> 8U),
                    static_cast<char>(code & 0xFFU)};
  frame += reason;
  return frame;
}

}  // namespace tweend::net
