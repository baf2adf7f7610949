#include <cstring>

#include "protocol/pose_q16.hpp"
#include "protocol/vertices_meshopt.hpp"
#include "protocol/vertices_q16.hpp"
#include "tests/fuzz/packet_stream.hpp"

namespace {

using namespace tweend;
using fuzz::require;

/// Any bits, again and again; none are zeros.
void fill(std::vector<float>& values, std::span<const std::byte> bits) {
  auto* const out = reinterpret_cast<std::byte*>(values.data());
  for (std::size_t i = 0; i < 4 * values.size(); ++i) out[i] = bits.empty() ? std::byte{} : bits[i % bits.size()];
}

/// An encoder and the decoder of its packets.
template <class Encoder, class Decoder>
struct Pair {
  template <class... More>
  void pass(const fuzz::Floats& in, bool key, std::size_t most_bytes, More... more) {
    std::vector<std::byte> out(most_bytes);  // of exactly its size, for AddressSanitizer
    const protocol::Encoded encoded = encoder.encode(in.a, in.b, key, out, more...);
    require(encoded.bytes <= out.size() && (encoded.key || !key));
    fuzz::Floats read(in.a.size(), in.b.size());
    require(decoder.decode(std::span(out).first(encoded.bytes), encoded.key, read.a, read.b).has_value());
    fuzz::require_numbers(read, true);
  }
  Encoder encoder;
  Decoder decoder;
};

}  // namespace

/// Any floats, as poses and as vertices: what encoders write can be read, and is numbers.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::PacketStream stream(data, size);
  const std::size_t elements = stream.number(300);
  Pair<protocol::PoseQ16Encoder, protocol::PoseQ16Decoder> poses;
  Pair<protocol::VerticesMeshoptEncoder, protocol::VerticesMeshoptDecoder> vertices;
  fuzz::PacketStream::Packet packet;
  while (stream.next(packet)) {
    const bool jumped = packet.variant % 2 != 0;
    const std::size_t n = elements + packet.variant / 2;
    fuzz::Floats pose(n * protocol::kFloatsPerJoint, n);
    fill(pose.a, packet.payload);
    fill(pose.b, packet.payload);
    poses.pass(pose, packet.key, protocol::PoseQ16Encoder::most_bytes(n, n), jumped);

    fuzz::Floats mesh(3 * n, 3 * n);
    fill(mesh.a, packet.payload);
    fill(mesh.b, packet.payload);
    vertices.pass(mesh, packet.key, protocol::VerticesMeshoptEncoder::most_bytes(n));
    std::vector<std::byte> q16(protocol::vertices_q16_bytes(n));
    protocol::encode_vertices_q16(mesh.a, mesh.b, q16);
    require(protocol::decode_vertices_q16(q16, mesh.a, mesh.b).has_value());
    fuzz::require_numbers(mesh, true);
  }
  return 0;
}
