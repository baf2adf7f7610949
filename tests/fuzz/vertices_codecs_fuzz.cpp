#include "protocol/vertices_meshopt.hpp"
#include "protocol/vertices_q16.hpp"
#include "tests/fuzz/packet_stream.hpp"

/// Packets of a stream of vertices, taken for meshopt and then for q16: each is read or refused, whatever came before.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tweend;
  fuzz::PacketStream stream(data, size);
  const std::size_t vertices = stream.number(700);
  protocol::VerticesMeshoptDecoder decoder, of_read_alone;
  fuzz::PacketStream::Packet packet;
  while (stream.next(packet)) {
    const std::size_t coordinates = 3 * (vertices + packet.variant);
    fuzz::Floats floats(coordinates, coordinates);
    fuzz::read_or_refuse(decoder, of_read_alone, packet, floats);
    fuzz::require_numbers(floats, protocol::decode_vertices_q16(packet.payload, floats.a, floats.b).has_value());
  }
  return 0;
}
