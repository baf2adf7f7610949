#pragma once

#include "protocol/vertex_quanta.hpp"
#include "server/base/result.hpp"

namespace tweend::protocol {

/// A grid as packets carry it: min xyz, extent xyz, float32.
inline constexpr std::size_t kGridBytes = 24;

void put_grid(std::byte* at, const PositionGrid& grid) noexcept;

/// @param payload  kGridBytes or more
/// @return Parse where a number is not finite, or an extent negative
[[nodiscard]] Result<PositionGrid> get_grid(std::span<const std::byte> payload);

}  // namespace tweend::protocol
