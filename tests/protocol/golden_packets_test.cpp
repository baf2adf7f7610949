// What has been written once is written again, byte for byte, and read as it was: other decoders rely on it.
// TWEEND_UPDATE_GOLDEN=1 build/release/bin/test_protocol --gtest_filter='GoldenPackets.*' writes the files anew.
#include "tests/protocol/golden_packets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "protocol/pose_q16.hpp"
#include "protocol/vertices_meshopt.hpp"
#include "protocol/vertices_q16.hpp"
#include "tests/protocol/codec_inputs.hpp"

namespace tweend::protocol {
namespace {

using Floats = std::span<const float>;

/// @param encode  (packet's floats, asked, room) → Encoded
/// @param decode  (payload, key, floats out) → Status
template <class Encode, class Decode>
void check(const std::string& name, const GoldenFile& inputs, std::size_t most_bytes, Encode encode, Decode decode) {
  GoldenFile found = updates_golden() ? inputs : read_golden(name);
  ASSERT_EQ(found.packets.size(), inputs.packets.size()) << name << " is not what this test writes";
  for (std::size_t i = 0; i < found.packets.size(); ++i) {
    GoldenPacket& packet = found.packets[i];
    std::vector<std::byte> payload(most_bytes);
    const Encoded encoded = encode(Floats(packet.in), packet.asked, std::span(payload));
    payload.resize(encoded.bytes);
    std::vector<float> out(packet.in.size());
    const Status status = decode(std::span<const std::byte>(updates_golden() ? payload : packet.payload), encoded.key, out);
    ASSERT_TRUE(status) << status.error().message;
    if (updates_golden()) {
      packet.key = encoded.key;
      packet.payload = payload;
      packet.out = out;
      continue;
    }
    EXPECT_EQ(encoded.key, packet.key) << name << ", packet " << i;
    EXPECT_EQ(payload, packet.payload) << name << ", packet " << i;
    for (std::size_t k = 0; k < out.size(); ++k) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(out[k]), std::bit_cast<std::uint32_t>(packet.out[k]))
          << name << ' ' << i << ' ' << k;
    }
  }
  if (updates_golden()) write_golden(name, found);
}

GoldenPacket packet_of(bool asked, const std::vector<float>& first, const std::vector<float>& second) {
  GoldenPacket packet;
  packet.asked = asked;
  packet.in = first;
  packet.in.insert(packet.in.end(), second.begin(), second.end());
  return packet;
}

/// Every section alone and together, nothing at all, a joint that leaves its range, a key on request.
GoldenFile poses() {
  constexpr std::size_t kJoints = 11;
  GoldenFile file{kJoints, 3, {}};
  Noise noise(5);
  Pose pose = resting_pose(kJoints, 3);
  pose.translation(0)[0] = 1000.0F;
  const auto add = [&](bool asked) { file.packets.push_back(packet_of(asked, pose.joints, pose.weights)); };
  for (std::size_t j = 0; j < kJoints; j += 2) turn(pose, j, noise);
  add(true);
  for (std::size_t j = 1; j < kJoints; j += 3) turn(pose, j, noise);
  add(false);
  add(false);
  for (std::size_t j = 0; j < kJoints; j += 5) pose.translation(j)[1] += 0.2F * noise.next();
  add(false);
  pose.translation(3)[2] += 7.0F;
  pose.weights[1] = 0.75F;
  add(false);
  for (std::size_t j = 0; j < kJoints; ++j) {
    turn(pose, j, noise);
    pose.translation(j)[0] += 0.1F * noise.next();
    pose.scale(j)[2] = 1.0F + 0.5F * noise.next();
  }
  pose.weights[2] = -0.5F;
  add(false);
  add(true);
  pose = resting_pose(kJoints, 3);
  add(false);
  return file;
}

GoldenFile vertices(std::size_t rings, std::size_t sides, bool in_a_row) {
  GoldenFile file;
  file.elements = static_cast<std::uint32_t>(rings * sides);
  const auto add = [&](bool asked, const Vertices& v) { file.packets.push_back(packet_of(asked, v.positions, v.normals)); };
  for (int i = 0; i < (in_a_row ? 4 : 1); ++i) add(i == 0, wavy_sphere(rings, sides, i / 60.0));
  Vertices flat = wavy_sphere(rings, sides, 0.25);
  for (std::size_t v = 0; v < file.elements; ++v) {
    flat.positions[3 * v + 1] = 3.0F;
    if (v % 2 == 0) std::fill_n(&flat.normals[3 * v], 3, 0.0F);
  }
  add(false, flat);
  Vertices grown = wavy_sphere(rings, sides, 0.5);
  for (float& x : grown.positions) x *= 4.0F;
  add(false, grown);
  add(true, wavy_sphere(rings, sides, 0.5));
  return file;
}

TEST(GoldenPackets, OfPosesAsQ16AreWrittenAndReadAsEver) {
  PoseQ16Encoder encoder;
  PoseQ16Decoder decoder;
  const GoldenFile file = poses();
  const std::size_t joints = file.elements * kFloatsPerJoint;
  check(
      "pose_q16.bin", file, PoseQ16Encoder::most_bytes(file.elements, file.weights),
      [&](Floats in, bool asked, std::span<std::byte> out) {
        return encoder.encode(in.first(joints), in.subspan(joints), asked, out);
      },
      [&](std::span<const std::byte> payload, bool key, std::span<float> out) {
        return decoder.decode(payload, key, out.first(joints), out.subspan(joints));
      });
}

TEST(GoldenPackets, OfVerticesAsQ16AreWrittenAndReadAsEver) {
  const GoldenFile file = vertices(3, 7, false);
  check(
      "vertices_q16.bin", file, vertices_q16_bytes(file.elements),
      [](Floats in, bool, std::span<std::byte> out) {
        encode_vertices_q16(in.first(in.size() / 2), in.last(in.size() / 2), out);
        return Encoded{out.size(), true};
      },
      [](std::span<const std::byte> payload, bool, std::span<float> out) {
        return decode_vertices_q16(payload, out.first(out.size() / 2), out.last(out.size() / 2));
      });
}

TEST(GoldenPackets, OfVerticesAsMeshoptAreWrittenAndReadAsEver) {
  VerticesMeshoptEncoder encoder;
  VerticesMeshoptDecoder decoder;
  const GoldenFile file = vertices(13, 20, true);
  check(
      "vertices_meshopt.bin", file, VerticesMeshoptEncoder::most_bytes(file.elements),
      [&](Floats in, bool asked, std::span<std::byte> out) {
        return encoder.encode(in.first(in.size() / 2), in.last(in.size() / 2), asked, out);
      },
      [&](std::span<const std::byte> payload, bool key, std::span<float> out) {
        return decoder.decode(payload, key, out.first(out.size() / 2), out.last(out.size() / 2));
      });
}

}  // namespace
}  // namespace tweend::protocol
