#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/vertex_quanta.hpp"

namespace tweend::protocol {

/// Vertices of a block, which meshoptimizer's codec has too: a foretelling for its positions, one for its normals.
inline constexpr std::size_t kBlockVertices = 256;
/// Bytes of a vertex in meshoptimizer's hands: low bytes of x, y, z, normal x, y; high bytes of the same; two zeros.
inline constexpr std::size_t kResidualStride = 12;

/// What each vertex of a block adds to the sums of its planes: the low byte to one, the high byte to another, both without a
/// carry. Shape [planes × vertices].
using BlockSteps = std::array<std::array<std::uint16_t, kBlockVertices>, VertexPlanes::kCount>;

/// The sums so far, in the order of a vertex's bytes as steps have them; begins with zeros.
using RecordSums = std::array<std::uint8_t, 16>;

/// Adds a block's steps up and writes the sums after each vertex.
/// @param sums  goes on from block to block; of no use after one that is shorter, the last
/// @param out   shape [n × kResidualStride], n at most kBlockVertices; two zeros end each vertex
void write_sums(const BlockSteps& steps, RecordSums& sums, std::span<std::byte> out) noexcept;

}  // namespace tweend::protocol
