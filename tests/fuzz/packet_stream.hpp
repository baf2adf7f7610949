#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace tweend::fuzz {

/// Bytes as the packets of one stream: a byte whether it is a key, two of its size, and the payload, again and again.
class PacketStream {
 public:
  struct Packet {
    bool key = false;
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
    packet.key = (byte() & 1U) != 0;
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

/// What was read are numbers; what was refused has left `untouched` everywhere.
inline void require_floats(std::span<const float> values, bool were_read, float untouched) {
  for (const float value : values) require(were_read ? std::isfinite(value) : value == untouched);
}

}  // namespace tweend::fuzz
