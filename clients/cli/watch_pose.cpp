#include "clients/cli/watch_pose.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "clients/cli/arguments.hpp"
#include "clients/cli/bounds.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/packet_stream.hpp"
#include "clients/cli/session.hpp"
#include "server/base/clock.hpp"

namespace tweend::cli {
namespace {

static_assert(std::endian::native == std::endian::little, "payloads are little-endian and copied as they are");

constexpr std::size_t kJointBytes = 10 * sizeof(float);  // translation, rotation, scale

/// How many joints and weights a packet holds, as the stream's layout says.
struct Shape {
  std::size_t joints;
  std::size_t weights;
  std::string first;  ///< the first joint's name
};

Shape shape_of(const Json& layout) {
  const Json joints = layout.value("joints", Json::array());
  const Json weights = layout.value("weights", Json::array());
  return {joints.size(), weights.size(), joints.empty() ? "" : brief_member(joints.front(), "name")};
}

std::string pose_json(const Packet& packet, const Shape& shape, ClockUs age_us) {
  Json json = packet_json(packet, age_us);
  json["joints"] = shape.joints;
  json["weights"] = shape.weights;
  json["bytes"] = packet.header.payload_bytes;
  return to_line(json);
}

std::string pose_text(const Packet& packet, const Shape& shape, ClockUs age_us) {
  std::string text =
      fmt::format("{}  {} {}", packet_text(packet, age_us), shape.joints, shape.joints == 1 ? "joint" : "joints");
  if (shape.weights > 0) text += fmt::format(", {} {}", shape.weights, shape.weights == 1 ? "weight" : "weights");
  if (shape.joints == 0 || packet.payload.size() < kJointBytes) return text;
  std::array<float, 3> translation{};
  std::memcpy(translation.data(), packet.payload.data(), sizeof translation);
  return text + fmt::format(", {} at {}", shape.first, point_text(translation));
}

}  // namespace

ExitCode watch_pose(Session& session, const Arguments& arguments) {
  Json params{{"kind", "pose"}, {"encoding", "f32"}};
  params.update(arguments.params);
  PacketStream stream(session, params);
  const Shape shape = shape_of(stream.layout());
  const auto count = arguments.get<std::uint64_t>("count", 0);
  for (std::uint64_t seen = 0; count == 0 || seen < count; ++seen) {
    const Packet packet = stream.next({});
    const ClockUs age_us = stream.age_us(packet, steady_now_us());
    const bool json = session.options().json;
    if (!session.print_line(json ? pose_json(packet, shape, age_us) : pose_text(packet, shape, age_us))) break;
  }
  return ExitCode::Done;
}

}  // namespace tweend::cli
