#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>

namespace tweend::protocol {

// Byte by byte, so that the order is the wire's and not the machine's; compilers make one store of it.

template <std::unsigned_integral T>
void put(std::byte* at, T value) noexcept {
  for (std::size_t i = 0; i < sizeof(T); ++i) at[i] = static_cast<std::byte>((std::uint64_t{value} >> (8 * i)) & 0xFFU);
}

template <std::unsigned_integral T>
[[nodiscard]] T get(const std::byte* at) noexcept {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>(value | (static_cast<T>(at[i]) << (8 * i)));
  return value;
}

inline void put_float(std::byte* at, float value) noexcept { put(at, std::bit_cast<std::uint32_t>(value)); }
[[nodiscard]] inline float get_float(const std::byte* at) noexcept { return std::bit_cast<float>(get<std::uint32_t>(at)); }

}  // namespace tweend::protocol
