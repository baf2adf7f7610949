#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tweend::protocol {

/// One packet of a golden file: what was encoded, what came of it, and what is read from that.
struct GoldenPacket {
  bool asked = false;  ///< whether a key was asked for
  bool key = false;    ///< whether it is one
  std::vector<std::byte> payload;
  std::vector<float> in;   ///< joints and then weights, or positions and then normals
  std::vector<float> out;  ///< likewise
};

/// Packets of one stream, in their order. In the file, little-endian: u32 elements, weights, packets; then for each packet
/// u32 flags (1 asked, 2 key), payload bytes and floats, and the payload, the floats in, the floats out. tests/web reads the
/// same files.
struct GoldenFile {
  std::uint32_t elements = 0;  ///< joints, or vertices
  std::uint32_t weights = 0;
  std::vector<GoldenPacket> packets;
};

/// Of tests/protocol/golden; empty where the file can't be read.
[[nodiscard]] GoldenFile read_golden(const std::string& name);
void write_golden(const std::string& name, const GoldenFile& file);

/// Whether TWEEND_UPDATE_GOLDEN=1 asks for the files anew. Decoders elsewhere read what was written before: bytes that change
/// are a change of the protocol.
[[nodiscard]] bool updates_golden();

}  // namespace tweend::protocol
