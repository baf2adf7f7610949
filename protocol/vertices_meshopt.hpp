#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "protocol/encoded.hpp"
#include "protocol/vertex_quanta.hpp"
#include "protocol/vertex_residuals.hpp"
#include "server/base/result.hpp"

namespace tweend::protocol {

/// Writes vertices as `meshopt` (docs/PROTOCOL.md, section 6.4): quantised, less what the packets before foretell, packed by
/// meshoptimizer's vertex codec. Keeps what the reader knows. Allocates only where the mesh is larger than any before. One
/// thread at a time.
class VerticesMeshoptEncoder {
 public:
  /// Bytes that a packet may take at most.
  [[nodiscard]] static std::size_t most_bytes(std::size_t vertices) noexcept;

  /// @param positions  shape [n × 3]
  /// @param normals    shape [n × 3], unit length or zero
  /// @param key        whether it has to decode on its own; without it, it still may
  /// @param out        room for most_bytes(n)
  [[nodiscard]] Encoded encode(std::span<const float> positions, std::span<const float> normals, bool key,
                               std::span<std::byte> out);

 private:
  VertexHistory history_;
  std::vector<std::byte> residuals_;  ///< shape [n × kResidualStride]
  PositionGrid grid_;
  Bounds room_;  ///< what grid_ holds; vertices out of it need a key
  Bounds last_;  ///< of the packet before
  bool is_known_ = false;
};

/// Reads them. Keeps what the packets before have said. One thread at a time.
class VerticesMeshoptDecoder {
 public:
  /// @param key  the packet's flag
  /// @return Parse naming what was expected and found where the bytes are not such a packet, or lack their predecessor; the
  ///         spans are untouched then, and the next packet may follow the one before this
  [[nodiscard]] Status decode(std::span<const std::byte> payload, bool key, std::span<float> positions,
                              std::span<float> normals);

 private:
  VertexHistory history_;
  std::vector<std::byte> residuals_;
  PositionGrid grid_;
  bool is_known_ = false;
};

}  // namespace tweend::protocol
