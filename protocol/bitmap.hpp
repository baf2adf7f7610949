#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <span>

namespace tweend::protocol {

/// Element e is bit e % 8 (of value 1 << e % 8) of byte e / 8; bits past the last element are 0.
[[nodiscard]] constexpr std::size_t bitmap_bytes(std::size_t elements) noexcept { return (elements + 7) / 8; }

class BitmapWriter {
 public:
  BitmapWriter(std::byte* out, std::size_t elements) noexcept : out_(out) {
    if (elements > 0) std::memset(out, 0, bitmap_bytes(elements));
  }
  void set(std::size_t element) noexcept {
    out_[element / 8] |= std::byte{1} << (element % 8);
    any_ = true;
  }
  [[nodiscard]] bool any() const noexcept { return any_; }

 private:
  std::byte* out_;
  bool any_ = false;
};

[[nodiscard]] inline bool bit_of(std::span<const std::byte> bitmap, std::size_t element) noexcept {
  return (bitmap[element / 8] >> (element % 8) & std::byte{1}) != std::byte{};
}

[[nodiscard]] inline std::size_t bits_set(std::span<const std::byte> bitmap) noexcept {
  std::size_t count = 0;
  for (const std::byte byte : bitmap) count += static_cast<std::size_t>(std::popcount(std::to_integer<unsigned>(byte)));
  return count;
}

}  // namespace tweend::protocol
