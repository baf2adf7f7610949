#include "protocol/vertices_meshopt.hpp"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>

#include "protocol/octahedral.hpp"
#include "protocol/vertex_grid_wire.hpp"

namespace tweend::protocol {
namespace {

/// How many packets a side of the bounds may go on as it has moved since the packet before without a new key.
constexpr float kPacketsAhead = 32.0F;

bool holds(const Bounds& room, const Bounds& bounds) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (bounds.min[k] < room.min[k] || bounds.max[k] > room.max[k]) return false;
  }
  return true;
}

/// `bounds` and a margin: at least a sixteenth of the extent, so that breathing needs no key, and at most half of the
/// largest extent, which costs one bit.
Bounds with_room(const Bounds& bounds, const Bounds& last) {
  std::array<float, 3> extent;
  for (std::size_t k = 0; k < 3; ++k) extent[k] = bounds.max[k] - bounds.min[k];
  const float most = *std::max_element(extent.begin(), extent.end()) / 2.0F;
  Bounds room;
  for (std::size_t k = 0; k < 3; ++k) {
    const float least = extent[k] / 16.0F;
    const auto margin = [&](float moved) { return std::clamp(kPacketsAhead * moved, least, most); };
    room.min[k] = std::max(bounds.min[k] - margin(last.min[k] - bounds.min[k]), -kFarthest);
    room.max[k] = std::min(bounds.max[k] + margin(bounds.max[k] - last.max[k]), kFarthest);
  }
  return room;
}

}  // namespace

std::size_t VerticesMeshoptEncoder::most_bytes(std::size_t vertices) noexcept {
  return kGridBytes + block_count(vertices) + meshopt_encodeVertexBufferBound(vertices, kResidualStride);
}

Encoded VerticesMeshoptEncoder::encode(std::span<const float> positions, std::span<const float> normals, bool key,
                                       std::span<std::byte> out) {
  // A setting of the whole library: later versions write by default what PROTOCOL.md does not promise.
  [[maybe_unused]] static const bool version_is_0 = (meshopt_encodeVertexVersion(0), true);
  const std::size_t n = positions.size() / 3;
  const Bounds bounds = bounds_of(positions);
  is_known_ = is_known_ && n == history_.vertices();
  key = key || !is_known_ || !holds(room_, bounds);
  if (key) {
    history_.resize(n);
    residuals_.resize(n * kResidualStride);
    room_ = with_room(bounds, is_known_ ? last_ : bounds);
    grid_ = PositionGrid(room_);
    put_grid(out.data(), grid_);
  }
  quantise_to_planes(positions, normals, grid_, history_.now());
  std::size_t at = key ? kGridBytes : 0;
  if (n > 0) {
    write_residuals(history_, key, out.subspan(at, block_count(n)), residuals_);
    at += block_count(n);
    at += meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data() + at), out.size() - at, residuals_.data(), n,
                                     kResidualStride);
  }
  history_.advance(key);
  last_ = bounds;
  is_known_ = true;
  return {at, key};
}

Status VerticesMeshoptDecoder::decode(std::span<const std::byte> payload, bool key, std::span<float> positions,
                                      std::span<float> normals) {
  const std::size_t n = positions.size() / 3;
  if (!key && !(is_known_ && n == history_.vertices())) {
    return fail(ErrorCode::Parse, fmt::format("expected a key of {} vertices first, found a packet that needs one", n));
  }
  const std::size_t before_residuals = (key ? kGridBytes : 0) + block_count(n);
  if (payload.size() < before_residuals) {
    return fail(ErrorCode::Parse, fmt::format("expected {} bytes or more for {} vertices as meshopt, found {}",
                                              before_residuals, n, payload.size()));
  }
  PositionGrid grid = grid_;
  if (key) {
    TWEEND_ASSIGN(grid, get_grid(payload));
  }
  const auto foretellings = payload.subspan(before_residuals - block_count(n), block_count(n));
  TWEEND_TRY(check_foretellings(key, foretellings));
  const auto packed = payload.subspan(before_residuals);
  residuals_.resize(n * kResidualStride);
  if (n == 0 ? !packed.empty()
             : meshopt_decodeVertexBuffer(residuals_.data(), n, kResidualStride,
                                          reinterpret_cast<const unsigned char*>(packed.data()), packed.size()) != 0) {
    return fail(ErrorCode::Parse,
                fmt::format("expected {} vertices of {} bytes as meshoptimizer packs them, found {} other bytes", n,
                            kResidualStride, packed.size()));
  }
  // Nothing is refused from here on, and until here nothing has changed.
  history_.resize(n);
  read_residuals(history_, foretellings, residuals_);
  const VertexPlanes now = history_.now();
  for (std::size_t v = 0; v < n; ++v) {
    const auto normal = decode_octahedral<kShortNormalBits>(static_cast<std::int16_t>(now.plane[3][v]),
                                                            static_cast<std::int16_t>(now.plane[4][v]));
    for (std::size_t k = 0; k < 3; ++k) {
      positions[3 * v + k] = grid.position(k, now.plane[k][v]);
      normals[3 * v + k] = normal[k];
    }
  }
  grid_ = grid;
  history_.advance(key);
  is_known_ = true;
  return {};
}

}  // namespace tweend::protocol
