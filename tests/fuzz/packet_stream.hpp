#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace tweend::fuzz {

/// Bytes as the packets of one stream: a byte whether it is a key and what else differs, two of its size, and the payload,
/// again and again.
class PacketStream {
 public:
  struct Packet {
    bool key = false;
    std::size_t variant = 0;  ///< 0 to 127: usually nothing, else a change of counts
    std::span<const std::byte> payload;
  };

  PacketStream(const std::uint8_t* data, std::size_t size) : rest_(std::as_bytes(std::span(data, size))) {}

  /// A number below `end` from the next two bytes; 0 where there are none.
  [[nodiscard]] std::size_t number(std::size_t end) {
    const std::size_t low = byte();
    return (low + 256 * byte()) % end;
  }
  [[nodiscard]] bool next(Packet& packet) {
    if (rest_.empty()) return false;
    const std::size_t first = byte();
    packet.key = (first & 1U) != 0;
    packet.variant = first >> 1U;
    const std::size_t wanted = number(65536);
    const std::size_t size = std::min(wanted, rest_.size());
    packet.payload = rest_.first(size);
    rest_ = rest_.subspan(size);
    return true;
  }

 private:
  [[nodiscard]] std::size_t byte() {
    if (rest_.empty()) return 0;
    const auto value = std::to_integer<std::size_t>(rest_.front());
    rest_ = rest_.subspan(1);
    return value;
  }
  std::span<const std::byte> rest_;
};

inline void require(bool holds) {
  if (!holds) std::abort();
}

/// Two arrays that a decoder is to fill: positions and normals, joints and weights.
struct Floats {
  static constexpr float kUntouched = -7.0F;
  Floats(std::size_t a_size, std::size_t b_size) : a(a_size, kUntouched), b(b_size, kUntouched) {}

  std::vector<float> a, b;
};

/// What was read are numbers; what was refused has left everything untouched.
inline void require_numbers(const Floats& floats, bool were_read) {
  for (const auto& values : {floats.a, floats.b}) {
    for (const float value : values) require(were_read ? std::isfinite(value) : value == Floats::kUntouched);
  }
}

/// Gives a packet to a decoder. What it refuses changes nothing of what it knows: another one, which has been given only what
/// was read, reads the same.
template <class Decoder>
void read_or_refuse(Decoder& decoder, Decoder& of_read_alone, const PacketStream::Packet& packet, const Floats& room) {
  Floats found = room;
  const bool were_read = decoder.decode(packet.payload, packet.key, found.a, found.b).has_value();
  require_numbers(found, were_read);
  if (!were_read) return;
  Floats again = room;
  require(of_read_alone.decode(packet.payload, packet.key, again.a, again.b).has_value());
  require(found.a == again.a && found.b == again.b);
}

}  // namespace tweend::fuzz
