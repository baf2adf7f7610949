#include "clients/cli/watch_pose.hpp"

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

std::string pose_json(const Packet& packet, const PoseReader& reader, ClockUs age_us) {
  Json json = packet_json(packet, age_us);
  json["joints"] = reader.joint_count();
  json["weights"] = reader.weight_count();
  json["bytes"] = packet.header.payload_bytes;
  return to_line(json);
}

/// @param first  the first joint's name
std::string pose_text(const Packet& packet, const PoseReader& reader, std::span<const float> joints, const std::string& first,
                      ClockUs age_us) {
  const std::size_t count = reader.joint_count();
  const std::size_t weights = reader.weight_count();
  std::string text = fmt::format("{}  {} {}", packet_text(packet, age_us), count, count == 1 ? "joint" : "joints");
  if (weights > 0) text += fmt::format(", {} {}", weights, weights == 1 ? "weight" : "weights");
  if (count == 0) return text;
  return text + fmt::format(", {} at {}", first, point_text({joints[0], joints[1], joints[2]}));
}

std::string first_joint(const Json& layout) {
  const Json joints = layout.value("joints", Json::array());
  return joints.empty() ? "" : brief_member(joints.front(), "name");
}

}  // namespace

ExitCode watch_pose(Session& session, const Arguments& arguments) {
  Json params{{"kind", "pose"}, {"encoding", "f32"}};
  params.update(arguments.params);
  PacketStream stream(session, params);
  PoseReader reader(stream.layout());
  const std::string first = first_joint(stream.layout());
  return print_packets(session, stream, arguments, [&](const Packet& packet, ClockUs age_us) {
    const auto joints = reader.joints(packet);
    return session.options().json ? pose_json(packet, reader, age_us) : pose_text(packet, reader, joints, first, age_us);
  });
}

}  // namespace tweend::cli
