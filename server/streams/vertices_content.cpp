#include "server/streams/vertices_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

namespace tweend::streams {

bool VerticesContent::follow(const stage::SceneViewPtr& view) {
  const auto& actors = view->scene->actors;
  const auto at =
      std::find_if(actors.begin(), actors.end(), [this](const model::ActorPtr& a) { return a->name == spec_.actor; });
  if (at == actors.end()) return false;
  // Another model of that name has other vertices than the layout that the client was told.
  if (view_ && view_->scene->actors[actor_]->model != (*at)->model) return false;
  actor_ = static_cast<std::size_t>(at - actors.begin());
  view_ = view;
  return true;
}

bool VerticesContent::shows_the_same(const stage::SceneView& next) const noexcept {
  return next.scene == view_->scene && (*next.players)[actor_] == (*view_->players)[actor_];
}

ContentReading VerticesContent::read(ClockUs at_us) {
  show_ = stage::show_actor(view_->scene->actors[actor_], (*view_->players)[actor_], at_us);
  return {show_.time_s, show_.moving, show_.continuity};
}

void VerticesContent::begin(NewPacketPtr packet, ClockUs) {
  packet_ = std::move(packet);
  packet_->header.kind = protocol::PacketKind::Vertices;
  packet_->header.encoding = protocol::kVerticesF32;
  workers_.post([this] { evaluate(); });
}

void VerticesContent::evaluate() {
  const std::span<float> out = packet_->payload.resize_floats(6 * show_.actor->model->vertex_count());
  const std::size_t half = out.size() / 2;
  // The lengths are right by construction: there is nothing to fail.
  static_cast<void>(evaluator_.vertices(*show_.actor, show_.shown, {out.first(half), out.subspan(half), {}}));
  boost::asio::post(strand_, [this] { evaluated(); });
}

void VerticesContent::evaluated() {
  show_ = {};
  NewPacketPtr packet = std::move(packet_);
  owner_.ready();
  owner_.made(std::move(packet));  // may be the last to hold this
}

std::string VerticesContent::what_is_gone() const {
  return fmt::format("the actor \"{}\" of the scene \"{}\" was removed", spec_.actor, scene_);
}

}  // namespace tweend::streams
