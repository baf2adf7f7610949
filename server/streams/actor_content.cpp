#include "server/streams/actor_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <utility>

namespace tweend::streams {

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

void VerticesContent::fill(const stage::ActorShow& show, model::Evaluator& evaluator, Packet& packet) const {
  packet.header.kind = protocol::PacketKind::Vertices;
  packet.header.encoding = protocol::kVerticesF32;
  const std::span<float> out = packet.payload.resize_floats(6 * show.actor->model->vertex_count());
  const std::size_t half = out.size() / 2;
  // The lengths are right by construction: there is nothing to fail.
  static_cast<void>(evaluator.vertices(*show.actor, show.shown, {out.first(half), out.subspan(half), {}}));
}

void PoseContent::fill(const stage::ActorShow& show, model::Evaluator& evaluator, Packet& packet) const {
  packet.header.kind = protocol::PacketKind::Pose;
  packet.header.encoding = protocol::kPoseF32;
  const animation::Pose& pose = evaluator.pose(*show.actor, show.shown);
  const std::size_t joints = pose.joint_count();
  const std::span<float> out = packet.payload.resize_floats(protocol::kFloatsPerJoint * joints + pose.weights().size());
  for (std::uint32_t j = 0; j < joints; ++j) {
    const animation::JointPose at = pose.joint(show.actor->model->skeleton->place_of(j));
    const std::array values{at.translation.x, at.translation.y, at.translation.z, at.rotation.x, at.rotation.y,
                            at.rotation.z,    at.rotation.w,    at.scale.x,       at.scale.y,    at.scale.z};
    std::copy(values.begin(), values.end(), out.begin() + static_cast<std::ptrdiff_t>(protocol::kFloatsPerJoint * j));
  }
  std::copy(pose.weights().begin(), pose.weights().end(), out.end() - static_cast<std::ptrdiff_t>(pose.weights().size()));
}

}  // namespace tweend::streams
