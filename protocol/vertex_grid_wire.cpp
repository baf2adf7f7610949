#include "protocol/vertex_grid_wire.hpp"

#include <fmt/format.h>

#include <cmath>

#include "protocol/little_endian.hpp"

namespace tweend::protocol {

void put_grid(std::byte* at, const PositionGrid& grid) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    put_float(at + 4 * k, grid.min[k]);
    put_float(at + 12 + 4 * k, grid.extent[k]);
  }
}

Result<PositionGrid> get_grid(std::span<const std::byte> payload) {
  PositionGrid grid;
  for (std::size_t k = 0; k < 3; ++k) {
    grid.min[k] = get_float(payload.data() + 4 * k);
    grid.extent[k] = get_float(payload.data() + 12 + 4 * k);
    const auto max = static_cast<float>(double{grid.min[k]} + double{grid.extent[k]});
    if (!std::isfinite(grid.min[k]) || !std::isfinite(max) || !(grid.extent[k] >= 0.0F)) {
      return fail(ErrorCode::Parse, fmt::format("expected finite bounds, found {} and an extent of {} along axis {}",
                                                grid.min[k], grid.extent[k], k));
    }
  }
  return grid;
}

}  // namespace tweend::protocol
