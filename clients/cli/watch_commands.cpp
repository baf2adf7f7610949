#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "clients/cli/arguments.hpp"
#include "clients/cli/bounds.hpp"
#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/packet_stream.hpp"
#include "clients/cli/picture_options.hpp"
#include "clients/cli/session.hpp"
#include "clients/cli/watch_frames.hpp"
#include "clients/cli/watch_pose.hpp"
#include "server/base/clock.hpp"

namespace tweend::cli {
namespace {

static_assert(std::endian::native == std::endian::little, "payloads are little-endian and copied as they are");

constexpr std::size_t kVertexBytes = 2 * 3 * sizeof(float);  // position and normal

/// The positions, which stand before the normals.
std::vector<float> positions(const Packet& packet) {
  std::vector<float> values(packet.payload.size() / kVertexBytes * 3);
  if (!values.empty()) std::memcpy(values.data(), packet.payload.data(), values.size() * sizeof(float));
  return values;
}

std::string vertices_json(const Packet& packet, ClockUs age_us) {
  Json json = packet_json(packet, age_us);
  json["vertices"] = packet.payload.size() / kVertexBytes;
  json["bytes"] = packet.header.payload_bytes;
  return to_line(json);
}

std::string vertices_text(const Packet& packet, ClockUs age_us) {
  const auto xyz = positions(packet);
  return fmt::format("{}  {} vertices, {}", packet_text(packet, age_us), xyz.size() / 3, bounds_text(xyz));
}

ExitCode watch_vertices(Session& session, const Arguments& arguments) {
  Json params{{"kind", "vertices"}, {"encoding", "f32"}};
  params.update(arguments.params);
  PacketStream stream(session, params);
  const auto count = arguments.get<std::uint64_t>("count", 0);
  for (std::uint64_t seen = 0; count == 0 || seen < count; ++seen) {
    const Packet packet = stream.next({});
    const ClockUs age_us = stream.age_us(packet, steady_now_us());
    if (!session.print_line(session.options().json ? vertices_json(packet, age_us) : vertices_text(packet, age_us))) break;
  }
  return ExitCode::Done;
}

Command& with_packets(Command& command, int rate = 30) {
  return command.option("--rate", "rate", number(), fmt::format("packets a second (default {})", rate))
      .option("--count", own("count"), count(), "stop after so many");
}

}  // namespace

void add_watch_commands(CommandSet& commands) {
  commands.group("watch", "Print or store what a stream sends.");
  with_packets(
      with_actor(
          commands.add("watch vertices", "Open a stream of vertices and print a line a packet, until interrupted.").in_scene()))
      .runs(watch_vertices);
  with_packets(
      with_actor(commands.add("watch pose", "Open a stream of poses and print a line a packet, until interrupted.").in_scene()),
      60)
      .runs(watch_pose);
  Command& frames =
      commands
          .add("watch frames", "Open a stream of pictures; store each in a file or print a line a packet, until interrupted.")
          .in_scene()
          .option("-o,--out", own("folder"), text("DIR"), "store them here, as frame_SEQUENCE.jpg or .png")
          .option("--encoding", "encoding", word("jpeg|png"), "(default jpeg)");
  with_picture(with_packets(frames)).runs(watch_frames);
}

}  // namespace tweend::cli
