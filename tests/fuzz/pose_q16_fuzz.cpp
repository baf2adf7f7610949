#include "protocol/pose_q16.hpp"

#include <vector>

#include "tests/fuzz/packet_stream.hpp"

/// Packets of a stream of poses: each is read or refused, whatever came before.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tweend;
  fuzz::PacketStream stream(data, size);
  const std::size_t joints = stream.number(40);
  const std::size_t weights = stream.number(20);
  protocol::PoseQ16Decoder decoder;
  fuzz::PacketStream::Packet packet;
  while (stream.next(packet)) {
    constexpr float kUntouched = -7.0F;
    std::vector<float> pose(joints * protocol::kFloatsPerJoint, kUntouched);
    std::vector<float> morphs(weights, kUntouched);
    const bool were_read = decoder.decode(packet.payload, packet.key, pose, morphs).has_value();
    fuzz::require_floats(pose, were_read, kUntouched);
    fuzz::require_floats(morphs, were_read, kUntouched);
  }
  return 0;
}
