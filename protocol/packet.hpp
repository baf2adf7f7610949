#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "server/base/result.hpp"

namespace tweend::protocol {

/// What a stream packet carries (docs/PROTOCOL.md, section 6).
enum class PacketKind : std::uint8_t { Pose = 1, Vertices = 2, Frame = 3 };

/// Pose payload: for each joint in the layout's order translation xyz, rotation xyzw, scale xyz as float32, local space; then
/// the morph weights, float32; little-endian.
inline constexpr std::uint8_t kPoseF32 = 0;
/// See pose_q16.hpp.
inline constexpr std::uint8_t kPoseQ16 = 1;
inline constexpr std::size_t kFloatsPerJoint = 10;

/// Vertices payload: n × 3 float32 positions, then n × 3 float32 normals, little-endian, model space.
inline constexpr std::uint8_t kVerticesF32 = 0;
/// See vertices_q16.hpp and vertices_meshopt.hpp.
inline constexpr std::uint8_t kVerticesQ16 = 1;
inline constexpr std::uint8_t kVerticesMeshopt = 2;

/// Encodings of a frame: a JPEG or PNG file, an Annex B access unit of H.264, or width × height × 4 bytes RGBA, sRGB, top row
/// first.
inline constexpr std::uint8_t kFrameJpeg = 0;
inline constexpr std::uint8_t kFramePng = 1;
inline constexpr std::uint8_t kFrameH264 = 2;
inline constexpr std::uint8_t kFrameRgba = 3;

/// Bits of PacketHeader::flags.
inline constexpr std::uint8_t kFlagKey = 1;            ///< decodes on its own
inline constexpr std::uint8_t kFlagDiscontinuity = 2;  ///< seek, wrap of an open clip, edit, clip change
inline constexpr std::uint8_t kFlagLast = 4;           ///< nothing follows until something changes

inline constexpr std::uint32_t kPacketMagic = 0x444E5754;  ///< "TWND"
inline constexpr std::uint8_t kPacketVersion = 1;
inline constexpr std::size_t kPacketHeaderBytes = 40;

using PacketHeaderBytes = std::array<std::byte, kPacketHeaderBytes>;

struct PacketHeader {
  PacketKind kind = PacketKind::Vertices;
  std::uint8_t encoding = kVerticesF32;
  std::uint8_t flags = 0;
  std::uint32_t stream = 0;    ///< this subscriber's number
  std::uint32_t sequence = 0;  ///< counts produced packets: a gap shows what was skipped
  std::int64_t media_us = 0;   ///< media time
  std::int64_t server_us = 0;  ///< the steady clock reading at which that media time holds
  std::uint32_t revision = 0;
  std::uint32_t payload_bytes = 0;  ///< what follows the 40 bytes

  bool operator==(const PacketHeader&) const = default;
};

/// The 40 bytes that go on the wire, little-endian whatever the machine.
[[nodiscard]] PacketHeaderBytes encode_header(const PacketHeader& header) noexcept;

/// @return Parse naming what was found where another magic, version or kind was expected
[[nodiscard]] Result<PacketHeader> decode_header(std::span<const std::byte, kPacketHeaderBytes> bytes);

}  // namespace tweend::protocol
