#pragma once

#include <cstddef>
#include <span>

#include "protocol/packet.hpp"
#include "server/base/result.hpp"

namespace tweend::protocol {

/// Bytes of a `q16` packet of so many vertices (docs/PROTOCOL.md, section 6.3).
[[nodiscard]] std::size_t vertices_q16_bytes(std::size_t vertices) noexcept;

/// Writes vertices as `q16`: positions quantised to the packet's own bounds, normals octahedral. Each packet decodes on its
/// own. Any thread.
/// @param positions  shape [n × 3]
/// @param normals    shape [n × 3], unit length or zero
/// @param out        vertices_q16_bytes(n) bytes
void encode_vertices_q16(std::span<const float> positions, std::span<const float> normals, std::span<std::byte> out) noexcept;

/// Reads them; normals are unit length.
/// @return Parse naming what was expected and found; the spans are untouched then
[[nodiscard]] Status decode_vertices_q16(std::span<const std::byte> payload, std::span<float> positions,
                                         std::span<float> normals);

}  // namespace tweend::protocol
