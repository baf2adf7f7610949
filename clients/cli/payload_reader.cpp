#include "clients/cli/payload_reader.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "clients/cli/failure.hpp"
#include "protocol/vertices_q16.hpp"

namespace tweend::cli {
namespace {

static_assert(std::endian::native == std::endian::little, "f32 payloads are little-endian and copied as they are");

using protocol::PacketKind;

constexpr std::size_t kFloatsPerVertex = 3;

std::span<const std::byte> bytes_of(const Packet& packet) { return std::as_bytes(std::span(packet.payload)); }

bool is_key(const Packet& packet) { return (packet.header.flags & protocol::kFlagKey) != 0; }

void check_kind(const Packet& packet, PacketKind expected) {
  if (packet.header.kind == expected) return;
  throw NoServer(fmt::format("packet {}: expected kind {}, found {}", packet.header.sequence, static_cast<int>(expected),
                             static_cast<int>(packet.header.kind)));
}

/// Floats one after another into spans one after another.
void copy_floats(const Packet& packet, std::span<float> first, std::span<float> second) {
  const std::size_t expected = first.size_bytes() + second.size_bytes();
  if (packet.payload.size() != expected) {
    throw NoServer(
        fmt::format("packet {}: expected {} bytes of f32, found {}", packet.header.sequence, expected, packet.payload.size()));
  }
  if (!first.empty()) std::memcpy(first.data(), packet.payload.data(), first.size_bytes());
  if (!second.empty()) std::memcpy(second.data(), packet.payload.data() + first.size_bytes(), second.size_bytes());
}

void check_decoded(const Packet& packet, const Status& status) {
  if (status) return;
  throw NoServer(fmt::format("packet {}: {}", packet.header.sequence, status.error().message));
}

[[noreturn]] void refuse_encoding(const Packet& packet, const char* expected) {
  throw NoServer(
      fmt::format("packet {}: expected {}, found encoding {}", packet.header.sequence, expected, packet.header.encoding));
}

std::size_t size_of_array(const Json& layout, const char* member) { return layout.value(member, Json::array()).size(); }

}  // namespace

VerticesReader::VerticesReader(const Json& layout)
    : count_(layout.value("vertices", std::size_t{0})),
      positions_(count_ * kFloatsPerVertex),
      normals_(count_ * kFloatsPerVertex) {}

std::span<const float> VerticesReader::positions(const Packet& packet) {
  check_kind(packet, PacketKind::Vertices);
  switch (packet.header.encoding) {
    case protocol::kVerticesF32:
      copy_floats(packet, positions_, normals_);
      break;
    case protocol::kVerticesQ16:
      check_decoded(packet, protocol::decode_vertices_q16(bytes_of(packet), positions_, normals_));
      break;
    case protocol::kVerticesMeshopt:
      check_decoded(packet, meshopt_.decode(bytes_of(packet), is_key(packet), positions_, normals_));
      break;
    default:
      refuse_encoding(packet, "vertices as f32, q16 or meshopt");
  }
  return positions_;
}

PoseReader::PoseReader(const Json& layout)
    : joint_count_(size_of_array(layout, "joints")),
      joints_(joint_count_ * protocol::kFloatsPerJoint),
      weights_(size_of_array(layout, "weights")) {}

std::span<const float> PoseReader::joints(const Packet& packet) {
  check_kind(packet, PacketKind::Pose);
  switch (packet.header.encoding) {
    case protocol::kPoseF32:
      copy_floats(packet, joints_, weights_);
      break;
    case protocol::kPoseQ16:
      check_decoded(packet, q16_.decode(bytes_of(packet), is_key(packet), joints_, weights_));
      break;
    default:
      refuse_encoding(packet, "a pose as f32 or q16");
  }
  return joints_;
}

}  // namespace tweend::cli
