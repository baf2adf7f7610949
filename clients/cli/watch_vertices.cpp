#include "clients/cli/watch_vertices.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "clients/cli/arguments.hpp"
#include "clients/cli/bounds.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/packet_stream.hpp"
#include "clients/cli/payload_reader.hpp"
#include "clients/cli/session.hpp"
#include "server/base/clock.hpp"

namespace tweend::cli {
namespace {

std::string vertices_json(const Packet& packet, std::span<const float> xyz, ClockUs age_us) {
  Json json = packet_json(packet, age_us);
  json["vertices"] = xyz.size() / 3;
  json["bytes"] = packet.header.payload_bytes;
  return to_line(json);
}

std::string vertices_text(const Packet& packet, std::span<const float> xyz, ClockUs age_us) {
  return fmt::format("{}  {} vertices, {}", packet_text(packet, age_us), xyz.size() / 3, bounds_text(xyz));
}

}  // namespace

ExitCode watch_vertices(Session& session, const Arguments& arguments) {
  Json params{{"kind", "vertices"}, {"encoding", "f32"}};
  params.update(arguments.params);
  PacketStream stream(session, params);
  VerticesReader reader(stream.layout());
  return print_packets(session, stream, arguments, [&](const Packet& packet, ClockUs age_us) {
    const auto xyz = reader.positions(packet);
    return session.options().json ? vertices_json(packet, xyz, age_us) : vertices_text(packet, xyz, age_us);
  });
}

}  // namespace tweend::cli
