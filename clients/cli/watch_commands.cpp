#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "clients/cli/arguments.hpp"
#include "clients/cli/bounds.hpp"
#include "clients/cli/clock_offset.hpp"
#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/connection.hpp"
#include "clients/cli/event.hpp"
#include "clients/cli/failure.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/session.hpp"
#include "server/base/clock.hpp"

namespace tweend::cli {
namespace {

static_assert(std::endian::native == std::endian::little, "payloads are little-endian and copied as they are");

constexpr std::size_t kVertexBytes = 2 * 3 * sizeof(float);  // position and normal

Json flag_words(std::uint8_t flags) {
  Json words = Json::array();
  if (flags & protocol::kFlagKey) words.push_back("key");
  if (flags & protocol::kFlagDiscontinuity) words.push_back("discontinuity");
  if (flags & protocol::kFlagLast) words.push_back("last");
  return words;
}

/// The positions, which stand before the normals.
std::vector<float> positions(const Packet& packet) {
  std::vector<float> values(packet.payload.size() / kVertexBytes * 3);
  if (!values.empty()) std::memcpy(values.data(), packet.payload.data(), values.size() * sizeof(float));
  return values;
}

Json header_json(const Packet& packet, ClockUs age_us) {
  const auto& header = packet.header;
  return {{"stream", header.stream},
          {"sequence", header.sequence},
          {"media_us", header.media_us},
          {"server_us", header.server_us},
          {"age_us", age_us},
          {"revision", header.revision},
          {"flags", flag_words(header.flags)},
          {"vertices", packet.payload.size() / kVertexBytes},
          {"bytes", header.payload_bytes}};
}

std::string packet_line(const Packet& packet, ClockUs age_us) {
  const auto& header = packet.header;
  const auto xyz = positions(packet);
  return fmt::format("#{:<6} {:>9.3f} s  age {:>6.1f} ms  {:<18}  {} vertices, {}", header.sequence,
                     static_cast<double>(header.media_us) * 1e-6, static_cast<double>(age_us) * 1e-3,
                     brief(flag_words(header.flags)), xyz.size() / 3, bounds_text(xyz));
}

/// Throws if the notification says that the stream has ended.
void check_ended(const std::string& line, const Json& stream) {
  const Json event = parse_event(line);
  if (event.at("method") != "stream.ended" || event.at("params").value("stream", Json()) != stream) return;
  throw Failure(ExitCode::Refused, "the stream has ended: " + brief_member(event.at("params"), "reason"));
}

ExitCode watch_vertices(Session& session, const Arguments& arguments) {
  const std::int64_t offset_us = measure_clock(session, 4).offset_us;
  Json params{{"kind", "vertices"}, {"encoding", "f32"}};
  params.update(arguments.params);
  const Json stream = session.call("stream.open", params).at("stream");
  const auto count = arguments.get<std::uint64_t>("count", 0);
  for (std::uint64_t seen = 0; count == 0 || seen < count;) {
    const Message message = session.next({});
    if (!message.packet) {
      check_ended(message.line, stream);
      continue;
    }
    ++seen;
    const ClockUs age_us = steady_now_us() + offset_us - message.packet->header.server_us;
    const bool json = session.options().json;
    if (!session.print_line(json ? to_line(header_json(*message.packet, age_us)) : packet_line(*message.packet, age_us))) break;
  }
  return ExitCode::Done;
}

}  // namespace

void add_watch_commands(CommandSet& commands) {
  commands.group("watch", "Print what a stream sends.");
  with_actor(
      commands.add("watch vertices", "Open a stream of vertices and print a line a packet, until interrupted.").in_scene())
      .option("--rate", "rate", number(), "packets a second (default 30)")
      .option("--count", own("count"), count(), "stop after so many")
      .runs(watch_vertices);
}

}  // namespace tweend::cli
