#include "protocol/pose_q16.hpp"

#include "tests/fuzz/packet_stream.hpp"

/// Packets of a stream of poses: each is read or refused, whatever came before.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tweend;
  fuzz::PacketStream stream(data, size);
  const std::size_t joints = stream.number(40);
  const std::size_t weights = stream.number(20);
  protocol::PoseQ16Decoder decoder, of_read_alone;
  fuzz::PacketStream::Packet packet;
  while (stream.next(packet)) {
    const std::size_t more_joints = packet.variant % 8;
    const std::size_t more_weights = packet.variant / 8;
    fuzz::read_or_refuse(decoder, of_read_alone, packet,
                         {(joints + more_joints) * protocol::kFloatsPerJoint, weights + more_weights});
  }
  return 0;
}
