// What the encodings of vertices and poses make of three meshes and four characters that move, at 60 packets a second, in bytes
// and in time: beside float32, the same deflated, and what glTF's EXT_meshopt_compression would make of each frame alone.

#include <meshoptimizer.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/support/character_clip.hpp"
#include "bench/support/moving_meshes.hpp"
#include "bench/support/ratio.hpp"
#include "bench/support/server_process.hpp"
#include "protocol/pose_q16.hpp"
#include "protocol/vertices_meshopt.hpp"
#include "protocol/vertices_q16.hpp"

namespace {

using namespace tweend;
using Frame = bench::MovingMesh::Frame;
using Bytes = std::vector<std::byte>;

// As docs/PROTOCOL.md states them.
constexpr double kFineAngle = 7e-5;
constexpr double kShortAngle = 1.1e-3;
constexpr double kRotationAngle = 1.5e-4;

std::size_t deflated(std::span<const float> values, int level, Bytes& out) {
  uLongf size = compressBound(values.size_bytes());
  out.resize(size);
  compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(values.data()), values.size_bytes(),
            level);
  return size;
}

/// Both halves of a packet as f32 has them.
std::vector<float> as_f32(const Frame& frame) {
  std::vector<float> all = frame.positions;
  all.insert(all.end(), frame.normals.begin(), frame.normals.end());
  return all;
}

double chord(const float* a, const float* b) {
  return std::hypot(double{a[0]} - b[0], double{a[1]} - b[1], double{a[2]} - b[2]);
}

/// Never time a wrong answer. For small angles chord and angle are the same.
void require_near(const Frame& in, const Frame& out, const std::byte* grid, double most_angle) {
  float extent[3];
  std::memcpy(extent, grid + 12, sizeof extent);
  for (std::size_t i = 0; i < in.positions.size(); ++i) {
    const double tolerance = 0.51 * double{extent[i % 3]} / 65535 + std::abs(double{in.positions[i]}) / (1 << 23);
    if (!(std::abs(double{in.positions[i]} - out.positions[i]) <= tolerance)) bench::give_up("a position is too far away");
  }
  for (std::size_t i = 0; i < in.normals.size(); i += 3) {
    if (!(chord(&in.normals[i], &out.normals[i]) <= most_angle + 1e-6)) bench::give_up("a normal is too far away");
  }
}

std::size_t packed(const void* data, std::size_t count, std::size_t stride) {
  std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(count, stride));
  return meshopt_encodeVertexBuffer(out.data(), out.size(), data, count, stride);
}

/// Positions of 16 bits and normals of 2 × 16, each stream by meshoptimizer: what a glTF file would hold.
std::size_t gltf_bytes(const Frame& frame) {
  const std::size_t n = frame.positions.size() / 3;
  Bytes q16(protocol::vertices_q16_bytes(n));
  protocol::encode_vertices_q16(frame.positions, frame.normals, q16);
  Bytes positions(8 * n);  // glTF aligns to 4
  for (std::size_t v = 0; v < n; ++v) std::memcpy(&positions[8 * v], &q16[24 + 6 * v], 6);
  std::vector<std::int16_t> normals(2 * n);
  std::memcpy(normals.data(), &q16[24 + 6 * n], 4 * n);
  for (std::int16_t& x : normals) x = static_cast<std::int16_t>(x / 16);  // 12 bits, as the packets'
  return packed(positions.data(), n, 8) + packed(normals.data(), n, 4);
}

struct MeshoptSizes {
  double key = 0.0;
  double mean = 0.0;  ///< of all packets, the key among them
};

MeshoptSizes check_meshopt(const bench::MovingMesh& mesh) {
  protocol::VerticesMeshoptEncoder encoder;
  protocol::VerticesMeshoptDecoder decoder;
  Bytes packet(protocol::VerticesMeshoptEncoder::most_bytes(mesh.vertices()));
  Bytes grid(24);
  Frame out = mesh.frames.front();
  std::size_t key = 0, sum = 0;
  for (const Frame& frame : mesh.frames) {
    const auto encoded = encoder.encode(frame.positions, frame.normals, false, packet);
    if (encoded.key) std::copy_n(packet.begin(), grid.size(), grid.begin());
    if (!decoder.decode(std::span(packet).first(encoded.bytes), encoded.key, out.positions, out.normals)) {
      bench::give_up("a packet as meshopt can't be read");
    }
    require_near(frame, out, grid.data(), kShortAngle);
    if (sum == 0) key = encoded.bytes;
    sum += encoded.bytes;
  }
  const auto n = static_cast<double>(mesh.vertices());
  return {static_cast<double>(key) / n, static_cast<double>(sum) / (n * static_cast<double>(mesh.frames.size()))};
}

void check_q16(const bench::MovingMesh& mesh) {
  Bytes packet(protocol::vertices_q16_bytes(mesh.vertices()));
  Frame out = mesh.frames.front();
  for (const Frame& frame : mesh.frames) {
    protocol::encode_vertices_q16(frame.positions, frame.normals, packet);
    if (!protocol::decode_vertices_q16(packet, out.positions, out.normals)) bench::give_up("a packet as q16 can't be read");
    require_near(frame, out, packet.data(), kFineAngle);
  }
}

/// Frame after frame there and back again, so that movement has no cuts.
const Frame& next(const bench::MovingMesh& mesh, std::size_t& count) {
  const std::size_t period = 2 * (mesh.frames.size() - 1);
  const std::size_t i = count++ % period;
  return mesh.frames[std::min(i, period - i)];
}

void race_vertices(const bench::MovingMesh& mesh, std::vector<bench::Claim>& claims) {
  check_q16(mesh);
  const MeshoptSizes sizes = check_meshopt(mesh);
  const std::size_t n = mesh.vertices();
  const auto per_vertex = [n](std::size_t bytes) { return static_cast<double>(bytes) / static_cast<double>(n); };
  Bytes out;
  const std::vector<float> f32 = as_f32(mesh.frames.front());
  const double zlib_1 = per_vertex(deflated(f32, 1, out));
  const double zlib_6 = per_vertex(deflated(f32, 6, out));
  const double q16 = per_vertex(protocol::vertices_q16_bytes(n));
  std::printf("%-10s %8zu %8.2f %8.2f %8.2f %8.2f %8.2f %8.2f %8.2f", mesh.name.c_str(), n, per_vertex(4 * f32.size()), zlib_1,
              zlib_6, per_vertex(gltf_bytes(mesh.frames.front())), q16, sizes.key, sizes.mean);

  protocol::VerticesMeshoptEncoder encoder;
  Bytes packet(protocol::VerticesMeshoptEncoder::most_bytes(n));
  std::vector<float> copy(f32.size());
  std::size_t q16_count = 0, meshopt_count = 0;
  const bench::Race race = bench::measure(
      {.items = static_cast<double>(n), .rounds = 9},
      [&] {
        std::memcpy(copy.data(), f32.data(), 4 * f32.size());
        bench::keep(copy.data());
      },
      [&] {
        const Frame& frame = next(mesh, q16_count);
        protocol::encode_vertices_q16(frame.positions, frame.normals, std::span(packet).first(protocol::vertices_q16_bytes(n)));
        bench::keep(packet.data());
      },
      [&] {
        const Frame& frame = next(mesh, meshopt_count);
        bench::keep(packet.data() + encoder.encode(frame.positions, frame.normals, false, packet).bytes);
      },
      [&] {
        static_cast<void>(deflated(f32, 1, out));
        bench::keep(out.data());
      });
  std::printf("   %6.2f %6.2f %6.1f %6.0f\n", race.ns(0), race.ns(1), race.ns(2), race.ns(3));
  if (mesh.name == "sphere") {
    claims.push_back({"vertices_meshopt_bytes_per_vertex", sizes.mean, 4.0});
    // 40 ns beside deflate's 415, as both are on a quiet machine; 34 to 38 were found, of which meshoptimizer alone takes 28.
    claims.push_back({"vertices_meshopt_encode_vs_deflate", race.ratio(2, 3), 0.096});
    claims.push_back({"vertices_q16_encode_vs_memcpy", race.ratio(1, 0), 5.0});
  }
}

// --------------------------------------------------------------------------------------------------------------- poses

using bench::kPoseFrames;
using bench::MovingPose;

constexpr std::size_t kKeyEvery = 60;
constexpr std::size_t kRotationAt = 3;
constexpr std::size_t kScaleAt = 7;

/// The hips go, and so many joints turn; the others rest. Or all of them turn, move and stretch.
MovingPose walk(std::string name, std::size_t turning, bool all_moves = false) {
  constexpr std::size_t kJoints = 67;
  const bench::CharacterClip clip(kJoints, 5.0, all_moves);
  bench::GlmPlayer player(clip);
  MovingPose moving{std::move(name), kJoints, {}};
  for (std::size_t i = 0; i < kPoseFrames; ++i) {
    const double t = static_cast<double>(i) / 60.0;
    player.sample(t);
    std::vector<float>& pose = moving.frames.emplace_back();
    for (std::size_t j = 0; j < kJoints; ++j) {
      const glm::vec3 at = all_moves ? player.translations[j] : clip.rest_translations[j];
      const glm::vec3 scale = all_moves ? player.scales[j] : glm::vec3(1.0F);
      const bool is_hips = j == 0;
      const glm::quat q = j < turning ? player.rotations[j] : glm::quat(1, 0, 0, 0);
      const auto walked = is_hips ? static_cast<float>(1.4 * t) : 0.0F;
      const auto bob = is_hips ? static_cast<float>(0.03 * std::sin(12.0 * t)) : 0.0F;
      for (const float x : {at.x, at.y + bob, at.z + walked, q.x, q.y, q.z, q.w, scale.x, scale.y, scale.z}) pose.push_back(x);
    }
  }
  return moving;
}

/// How far each number goes: largest less least.
std::vector<float> ways(const MovingPose& moving) {
  std::vector<float> least = moving.frames.front(), most = least;
  for (const auto& frame : moving.frames) {
    for (std::size_t i = 0; i < frame.size(); ++i)
      least[i] = std::min(least[i], frame[i]), most[i] = std::max(most[i], frame[i]);
  }
  for (std::size_t i = 0; i < most.size(); ++i) most[i] -= least[i];
  return most;
}

std::size_t moving_joints(const std::vector<float>& way) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < way.size(); i += 10) count += std::any_of(&way[i], &way[i] + 10, [](float x) { return x > 0; });
  return count;
}

/// Of three numbers: what docs/PROTOCOL.md allows them, as they went so far at most and began with half of this step.
void require_near(const float* in, const float* out, const float* way, double first_step) {
  const double far = std::max({way[0], way[1], way[2]});
  for (std::size_t k = 0; k < 3; ++k) {
    const double tolerance = std::max(far * 4 / 32767, first_step / 2) + std::abs(double{in[k]}) / (1 << 23);
    if (!(std::abs(double{in[k]} - out[k]) <= tolerance)) bench::give_up("a joint is too far away");
  }
}

void require_near(const std::vector<float>& in, const std::vector<float>& out, const std::vector<float>& way) {
  for (std::size_t i = 0; i < in.size(); i += 10) {
    double plus = 0.0, minus = 0.0;
    for (std::size_t k = i + kRotationAt; k < i + kScaleAt; ++k) {
      plus += std::pow(double{in[k]} + out[k], 2), minus += std::pow(double{in[k]} - out[k], 2);
    }
    if (!(2.0 * std::sqrt(std::min(plus, minus)) <= kRotationAngle + 2e-6)) bench::give_up("a rotation is too far away");
    require_near(&in[i], &out[i], &way[i], std::ldexp(1.0, -17));
    require_near(&in[i + kScaleAt], &out[i + kScaleAt], &way[i + kScaleAt], std::ldexp(1.0, -14));
  }
}

/// Rotations by the quaternion filter, translations and scales by the exponential one: what a glTF file would hold.
std::size_t gltf_bytes(const std::vector<float>& pose) {
  const std::size_t joints = pose.size() / 10;
  std::size_t bytes = 0;
  std::vector<float> values;
  for (const auto& [at, size] : {std::pair{std::size_t{0}, std::size_t{3}}, {kRotationAt, 4}, {kScaleAt, 3}}) {
    values.clear();
    for (std::size_t j = 0; j < joints; ++j) values.insert(values.end(), &pose[10 * j + at], &pose[10 * j + at] + size);
    const std::size_t stride = at == kRotationAt ? 8 : 12;
    Bytes filtered(joints * stride);
    if (at == kRotationAt) {
      meshopt_encodeFilterQuat(filtered.data(), joints, stride, 16, values.data());
    } else {
      meshopt_encodeFilterExp(filtered.data(), joints, stride, 16, values.data());
    }
    bytes += packed(filtered.data(), joints, stride);
  }
  return bytes;
}

/// @return bytes of a moving joint
double race_poses(const MovingPose& moving) {
  const auto& poses = moving.frames;
  const std::size_t joints = moving.joints;
  const std::vector<float> way = ways(moving);
  protocol::PoseQ16Encoder encoder;
  protocol::PoseQ16Decoder decoder;
  Bytes packet(protocol::PoseQ16Encoder::most_bytes(joints, 0));
  Bytes out;
  std::vector<float> back(10 * joints);
  std::size_t sum = 0, zlib = 0, gltf = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto encoded = encoder.encode(poses[i], {}, i % kKeyEvery == 0, packet);
    if (!decoder.decode(std::span(packet).first(encoded.bytes), encoded.key, back, {})) bench::give_up("a pose can't be read");
    require_near(poses[i], back, way);
    sum += encoded.bytes;
    zlib += deflated(poses[i], 1, out);
    gltf += gltf_bytes(poses[i]);
  }
  const auto per_joint = [](std::size_t bytes, std::size_t of) {
    return static_cast<double>(bytes) / static_cast<double>(of * kPoseFrames);
  };
  std::size_t count = 0;
  const bench::Race race = bench::measure(
      {.items = static_cast<double>(joints), .rounds = 21, .batch_ns = 200'000},
      [&] {
        std::memcpy(back.data(), poses[count++ % kPoseFrames].data(), 4 * back.size());
        bench::keep(back.data());
      },
      [&] {
        const std::size_t i = count++ % kPoseFrames;
        bench::keep(packet.data() + encoder.encode(poses[i], {}, i % kKeyEvery == 0, packet).bytes);
      },
      [&] {
        static_cast<void>(deflated(poses[count++ % kPoseFrames], 1, out));
        bench::keep(out.data());
      });
  const double of_a_moving_joint = per_joint(sum, moving_joints(way));
  std::printf("%-24s %8zu %8.1f %8.2f %8.2f %8.2f %10.2f   %6.2f %6.1f %6.0f\n", moving.name.c_str(), joints, 40.0,
              per_joint(zlib, joints), per_joint(gltf, joints), per_joint(sum, joints), of_a_moving_joint, race.ns(0),
              race.ns(1), race.ns(2));
  return of_a_moving_joint;
}

}  // namespace

int main() {
  std::vector<bench::Claim> claims;
  std::printf("vertices, 12 packets at 60 a second: bytes a vertex, and ns a vertex to encode, one core\n");
  std::printf("%-10s %8s %8s %8s %8s %8s %8s %8s %8s   %6s %6s %6s %6s\n", "", "vertices", "f32", "zlib 1", "zlib 6", "glTF",
              "q16", "meshopt", "meshopt", "memcpy", "q16", "mesh-", "zlib 1");
  std::printf("%-10s %8s %8s %8s %8s %8s %8s %8s %8s   %6s %6s %6s\n", "", "", "", "", "", "", "", "key", "mean", "", "",
              "opt");
  race_vertices(bench::moving_sphere(), claims);
  race_vertices(bench::moving_character(TWEEND_DEMO_ASSETS, "walker.glb"), claims);
  race_vertices(bench::moving_flag(), claims);
  std::printf("\nposes, four seconds at 60 a second, a key each: bytes a joint, and ns a joint to encode\n");
  std::printf("%-24s %8s %8s %8s %8s %8s %10s   %6s %6s %6s\n", "", "joints", "f32", "zlib 1", "glTF", "q16", "a moving",
              "memcpy", "q16", "zlib 1");
  const double most = std::max({race_poses(walk("all joints turn", 67)), race_poses(walk("20 joints turn", 20)),
                                race_poses(bench::moving_pose(TWEEND_DEMO_ASSETS, "walker.glb"))});
  claims.push_back({"pose_q16_bytes_per_moving_joint", most, 10.0});
  race_poses(walk("all turn, move, stretch", 67, true));  // 18 bytes a packet are three properties of a joint
  return bench::report(claims) ? 0 : 1;
}
