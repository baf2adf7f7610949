#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tweend::model {

/// 128 bits that name a value by its content (XXH3): equal content, equal name, on every machine of one byte order.
/// Not cryptographic: it tells values apart, it does not guard against whoever may edit them anyway.
struct ContentHash {
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  auto operator<=>(const ContentHash&) const = default;
};

[[nodiscard]] ContentHash hash_bytes(std::span<const std::byte> bytes) noexcept;

/// 32 hexadecimal digits.
[[nodiscard]] std::string to_string(const ContentHash& hash);

}  // namespace tweend::model
