#include "server/streams/actor_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <utility>

#include "protocol/vertices_q16.hpp"

namespace tweend::streams {
namespace {

bool is_key(const Packet& packet) noexcept { return (packet.header.flags & protocol::kFlagKey) != 0; }
bool jumped(const Packet& packet) noexcept { return (packet.header.flags & protocol::kFlagDiscontinuity) != 0; }

/// What an encoder has made of a packet, at the front of `draft`.
void finish(Packet& packet, const Payload& draft, protocol::Encoded encoded) {
  packet.payload.assign(draft.bytes().first(encoded.bytes));
  if (encoded.key) packet.header.flags = static_cast<std::uint8_t>(packet.header.flags | protocol::kFlagKey);
}

}  // namespace

bool ActorContent::follow(const stage::SceneViewPtr& view) {
  const auto& actors = view->scene->actors;
  const auto at =
      std::find_if(actors.begin(), actors.end(), [this](const model::ActorPtr& a) { return a->name == actor_name_; });
  if (at == actors.end()) return false;
  // Another model of that name has other vertices than the layout that the client was told.
  if (view_ && view_->scene->actors[actor_]->model != (*at)->model) return false;
  actor_ = static_cast<std::size_t>(at - actors.begin());
  view_ = view;
  return true;
}

bool ActorContent::shows_the_same(const stage::SceneView& next) const noexcept {
  return next.scene == view_->scene && (*next.players)[actor_] == (*view_->players)[actor_];
}

ContentReading ActorContent::read(ClockUs at_us) {
  show_ = stage::show_actor(view_->scene->actors[actor_], (*view_->players)[actor_], at_us);
  return {show_.time_s, show_.moving, show_.continuity};
}

void ActorContent::begin(NewPacketPtr packet, ClockUs) {
  packet_ = std::move(packet);
  workers_.post([this] { evaluate(); });
}

void ActorContent::evaluate() {
  fill(show_, evaluator_, *packet_);
  boost::asio::post(strand_, [this] { evaluated(); });
}

void ActorContent::evaluated() {
  show_ = {};
  NewPacketPtr packet = std::move(packet_);
  owner_.ready();
  owner_.made(std::move(packet));  // may be the last to hold this
}

std::string ActorContent::what_is_gone() const {
  return fmt::format("the actor \"{}\" of the scene \"{}\" was removed", actor_name_, scene_);
}

void VerticesContent::fill(const stage::ActorShow& show, model::Evaluator& evaluator, Packet& packet) {
  const std::size_t count = show.actor->model->vertex_count();
  std::span<float> out;
  if (encoding_ == VerticesEncoding::F32) {
    out = packet.payload.resize_floats(6 * count);
  } else {
    floats_.resize(6 * count);
    out = floats_;
  }
  const std::span<float> positions = out.first(3 * count);
  const std::span<float> normals = out.subspan(3 * count);
  // The lengths are right by construction: there is nothing to fail.
  static_cast<void>(evaluator.vertices(*show.actor, show.shown, {positions, normals, {}}));

  packet.header.kind = protocol::PacketKind::Vertices;
  packet.header.encoding = protocol::kVerticesF32;
  if (encoding_ == VerticesEncoding::Q16) {
    packet.header.encoding = protocol::kVerticesQ16;
    protocol::encode_vertices_q16(positions, normals, packet.payload.resize(protocol::vertices_q16_bytes(count)));
  } else if (encoding_ == VerticesEncoding::Meshopt) {
    packet.header.encoding = protocol::kVerticesMeshopt;
    finish(packet, draft_,
           meshopt_.encode(positions, normals, is_key(packet),
                           draft_.resize(protocol::VerticesMeshoptEncoder::most_bytes(count))));
  }
}

void PoseContent::fill(const stage::ActorShow& show, model::Evaluator& evaluator, Packet& packet) {
  const animation::Pose& pose = evaluator.pose(*show.actor, show.shown);
  const std::size_t joints = pose.joint_count();
  const std::size_t count = protocol::kFloatsPerJoint * joints + pose.weights().size();
  std::span<float> out;
  if (encoding_ == PoseEncoding::F32) {
    out = packet.payload.resize_floats(count);
  } else {
    floats_.resize(count);
    out = floats_;
  }
  for (std::uint32_t j = 0; j < joints; ++j) {
    const animation::JointPose at = pose.joint(show.actor->model->skeleton->place_of(j));
    const std::array values{at.translation.x, at.translation.y, at.translation.z, at.rotation.x, at.rotation.y,
                            at.rotation.z,    at.rotation.w,    at.scale.x,       at.scale.y,    at.scale.z};
    std::copy(values.begin(), values.end(), out.begin() + static_cast<std::ptrdiff_t>(protocol::kFloatsPerJoint * j));
  }
  const std::span<float> weights = out.subspan(protocol::kFloatsPerJoint * joints);
  std::copy(pose.weights().begin(), pose.weights().end(), weights.begin());

  packet.header.kind = protocol::PacketKind::Pose;
  packet.header.encoding = protocol::kPoseF32;
  if (encoding_ == PoseEncoding::F32) return;
  packet.header.encoding = protocol::kPoseQ16;
  finish(packet, draft_,
         q16_.encode(out.first(out.size() - weights.size()), weights, is_key(packet),
                     draft_.resize(protocol::PoseQ16Encoder::most_bytes(joints, weights.size())), jumped(packet)));
}

}  // namespace tweend::streams
