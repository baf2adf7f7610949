#include "protocol/vertices_q16.hpp"

#include <fmt/format.h>

#include "protocol/little_endian.hpp"
#include "protocol/octahedral.hpp"
#include "protocol/vertex_grid_wire.hpp"
#include "protocol/vertex_quanta.hpp"

namespace tweend::protocol {
namespace {

constexpr std::size_t kPositionBytes = 6;
constexpr std::size_t kNormalBytes = 4;

std::int16_t signed_at(const std::byte* at) { return static_cast<std::int16_t>(get<std::uint16_t>(at)); }

}  // namespace

std::size_t vertices_q16_bytes(std::size_t vertices) noexcept {
  return kGridBytes + vertices * (kPositionBytes + kNormalBytes);
}

void encode_vertices_q16(std::span<const float> positions, std::span<const float> normals, std::span<std::byte> out) noexcept {
  const PositionGrid grid(bounds_of(positions));
  put_grid(out.data(), grid);
  std::byte* const out_positions = out.data() + kGridBytes;
  quantise_interleaved(positions, normals, grid, out_positions, out_positions + positions.size() / 3 * kPositionBytes);
}

Status decode_vertices_q16(std::span<const std::byte> payload, std::span<float> positions, std::span<float> normals) {
  const std::size_t n = positions.size() / 3;
  if (payload.size() != vertices_q16_bytes(n)) {
    return fail(ErrorCode::Parse,
                fmt::format("expected {} bytes for {} vertices as q16, found {}", vertices_q16_bytes(n), n, payload.size()));
  }
  TWEEND_ASSIGN(const PositionGrid grid, get_grid(payload));
  const std::byte* at = payload.data() + kGridBytes;
  for (std::size_t i = 0; i < 3 * n; ++i, at += 2) positions[i] = grid.position(i % 3, get<std::uint16_t>(at));
  for (std::size_t v = 0; v < n; ++v, at += kNormalBytes) {
    const auto normal = decode_octahedral<kFineNormalBits>(signed_at(at), signed_at(at + 2));
    for (std::size_t k = 0; k < 3; ++k) normals[3 * v + k] = normal[k];
  }
  return {};
}

}  // namespace tweend::protocol
