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
  const auto count = arguments.get<std::uint64_t>("count", 0);
  for (std::uint64_t seen = 0; count == 0 || seen < count; ++seen) {
    const Packet packet = stream.next({});
    const ClockUs age_us = stream.age_us(packet, steady_now_us());
    const auto xyz = reader.positions(packet);
    const bool json = session.options().json;
    if (!session.print_line(json ? vertices_json(packet, xyz, age_us) : vertices_text(packet, xyz, age_us))) break;
  }
  return ExitCode::Done;
}

}  // namespace tweend::cli
