#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "protocol/vertex_quanta.hpp"
#include "protocol/vertex_records.hpp"
#include "server/base/result.hpp"

namespace tweend::protocol {

/// The integers of one packet and of the two before it, as writer and reader both know them.
class VertexHistory {
 public:
  /// Forgets everything where n differs from before; allocates only where it is more than ever.
  void resize(std::size_t vertices);
  /// After a packet: `now` becomes the one before, and after a key both that came before.
  void advance(bool key) noexcept;

  [[nodiscard]] std::size_t vertices() const noexcept { return vertices_; }
  [[nodiscard]] VertexPlanes now() noexcept { return planes(now_); }
  /// @param age  1: the packet before, 2: the one before that
  [[nodiscard]] VertexPlanes before(std::size_t age) noexcept { return planes(age == 1 ? before_ : earlier_); }

 private:
  [[nodiscard]] VertexPlanes planes(std::size_t slot) noexcept;

  std::size_t vertices_ = 0;
  std::size_t now_ = 0, before_ = 1, earlier_ = 2;  ///< slots
  std::vector<std::uint16_t> integers_;             ///< shape [3 slots × planes × vertices]
};

/// How the integers of a block are foretold: by so many packets before, and what that leaves by so many vertices before.
struct Foretelling {
  std::uint8_t time = 0;   ///< 0 nothing, 1 the same as in the packet before, 2 moving on as between the two before
  std::uint8_t space = 0;  ///< 0 nothing, 1 the same as the vertex before, 2 going on as between the two before
};

[[nodiscard]] constexpr std::size_t block_count(std::size_t vertices) noexcept {
  return (vertices + kBlockVertices - 1) / kBlockVertices;
}

/// What is left of history.now() once foretold, each block in the way that leaves the least.
/// @param key           whether the packets before don't count
/// @param foretellings  shape [block_count()]: a byte each, as the packet carries it
/// @param residuals     shape [n × kResidualStride]; all of it is written
void write_residuals(VertexHistory& history, bool key, std::span<std::byte> foretellings,
                     std::span<std::byte> residuals) noexcept;

/// @return Parse where a byte is no foretelling, or one by packets before in a key
[[nodiscard]] Status check_foretellings(bool key, std::span<const std::byte> foretellings);

/// The way back: gives history.now() its values.
/// @param foretellings  that check_foretellings() has passed
void read_residuals(VertexHistory& history, std::span<const std::byte> foretellings,
                    std::span<const std::byte> residuals) noexcept;

}  // namespace tweend::protocol
