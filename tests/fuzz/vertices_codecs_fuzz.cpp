#include <vector>

#include "protocol/vertices_meshopt.hpp"
#include "protocol/vertices_q16.hpp"
#include "tests/fuzz/packet_stream.hpp"

/// Packets of a stream of vertices, taken for meshopt and then for q16: each is read or refused, whatever came before.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tweend;
  fuzz::PacketStream stream(data, size);
  const std::size_t vertices = stream.number(700);
  protocol::VerticesMeshoptDecoder decoder;
  fuzz::PacketStream::Packet packet;
  while (stream.next(packet)) {
    constexpr float kUntouched = -7.0F;
    for (const bool as_meshopt : {true, false}) {
      std::vector<float> positions(3 * vertices, kUntouched);
      std::vector<float> normals(3 * vertices, kUntouched);
      const bool were_read = (as_meshopt ? decoder.decode(packet.payload, packet.key, positions, normals)
                                         : protocol::decode_vertices_q16(packet.payload, positions, normals))
                                 .has_value();
      fuzz::require_floats(positions, were_read, kUntouched);
      fuzz::require_floats(normals, were_read, kUntouched);
    }
  }
  return 0;
}
