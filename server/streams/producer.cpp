#include "server/streams/producer.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cmath>
#include <utility>

#include "server/stage/player.hpp"

namespace tweend::streams {
namespace {

std::int64_t media_us(double time_s) noexcept { return std::llround(time_s * 1e6); }

}  // namespace

Producer::Producer(StreamKey key, std::uint64_t source, stage::SceneViewPtr view, Environment environment)
    : key_(std::move(key)),
      source_(source),
      environment_(std::move(environment)),
      start_us_(steady_now_us()),
      timer_(environment_.strand) {
  // The hub looked before it leapt: the actor is there.
  static_cast<void>(follow(std::move(view)));
}

bool Producer::follow(stage::SceneViewPtr view) {
  const auto& actors = view->scene->actors;
  const auto at =
      std::find_if(actors.begin(), actors.end(), [this](const model::ActorPtr& a) { return a->name == key_.actor; });
  if (at == actors.end()) return false;
  if (view_ && view_->scene->actors[actor_]->mesh != (*at)->mesh) return false;
  const auto actor = static_cast<std::size_t>(at - actors.begin());
  if (view_ && evaluated_serial_ == view_->serial && shows_the_same(*view, actor)) {
    // Another actor's player: what has been sent of this one is as good for the new view.
    evaluated_serial_ = view->serial;
    if (!evaluating_) delivered_serial_ = view->serial;
  }
  actor_ = actor;
  view_ = std::move(view);
  if (!idle()) schedule();
  return true;
}

bool Producer::shows_the_same(const stage::SceneView& next, std::size_t actor) const noexcept {
  return next.scene->revision == view_->scene->revision && (*next.players)[actor] == (*view_->players)[actor_];
}

stage::ActorShow Producer::show(ClockUs at_us) const noexcept {
  return stage::show_actor(view_->scene->actors[actor_], (*view_->players)[actor_], at_us);
}

void Producer::add(Subscription subscription) {
  auto next = std::make_shared<Subscriptions>(*subscriptions_);
  next->push_back(subscription);
  subscriptions_ = std::move(next);
  if (latest_) {  // whatever has changed since is on its way to all
    environment_.mailbox.put({latest_, std::make_shared<const Subscriptions>(Subscriptions{std::move(subscription)})});
  }
  schedule();
}

void Producer::remove(const PacketSink* sink, std::uint32_t stream) {
  auto next = std::make_shared<Subscriptions>(*subscriptions_);
  std::erase_if(*next, [&](const Subscription& s) {
    const auto held = s.sink.lock();
    return !held || (held.get() == sink && s.stream == stream);
  });
  subscriptions_ = std::move(next);
}

void Producer::end(const std::string& reason) {
  environment_.mailbox.call([to = subscriptions_, reason] {
    for (const Subscription& s : *to) {
      if (const auto sink = s.sink.lock()) sink->ended(s.stream, reason);
    }
  });
  stop();
}

void Producer::stop() {
  timer_.cancel();
  subscriptions_ = std::make_shared<const Subscriptions>();
}

void Producer::schedule() {
  if (scheduled_ || evaluating_ || idle()) return;
  const bool changed = evaluated_serial_ != view_->serial;
  if (!changed && settled_) return;
  const ClockUs now_us = steady_now_us();
  constexpr double kLongestUs = 1e15;  // decades: what the clock can still count
  const double period_us = std::min(1e6 / key_.rate, kLongestUs);
  // The next reading of the grid; a change after a pause, and the very first packet, need no grid to wait for.
  const auto reading = static_cast<std::int64_t>(std::floor(static_cast<double>(now_us - start_us_) / period_us)) + 1;
  const bool at_once = changed && (sequence_ == 0 || static_cast<double>(now_us - last_at_us_) >= period_us);
  const ClockUs at_us = at_once ? now_us : start_us_ + static_cast<ClockUs>(static_cast<double>(reading) * period_us);
  if (sequence_ != 0 && !settled_) {
    tweend::add(environment_.metrics.ticks_missed_total, std::max<std::int64_t>(0, reading - last_reading_ - 1));
  }
  last_reading_ = at_once ? reading - 1 : reading;
  scheduled_ = true;
  timer_.expires_at(instant(at_us));
  timer_.async_wait([self = shared_from_this(), at_us](const boost::system::error_code& error) {
    self->scheduled_ = false;
    if (!error && !self->idle()) self->tick(at_us);
  });
}

void Producer::tick(ClockUs at_us) {
  const ClockUs now_us = steady_now_us();
  // The machine was away: show now, not then. And never a playhead at a reading before it was set.
  if (static_cast<double>(now_us - at_us) >= 1e6 / key_.rate) at_us = now_us;
  evaluate(std::max(at_us, (*view_->players)[actor_].anchor_us));
}

void Producer::evaluate(ClockUs at_us) {
  making_show_ = show(at_us);
  const stage::ActorShow& show = making_show_;
  making_ = pool_->take(6 * show.actor->mesh->vertex_count());
  making_->source = source_;
  const std::uint64_t revision = view_->scene->revision;
  const bool jumped = sequence_ != 0 && (show.continuity != continuity_ || revision != revision_);
  protocol::PacketHeader& header = making_->header;
  header.kind = protocol::PacketKind::Vertices;
  header.encoding = protocol::kVerticesF32;
  header.flags = static_cast<std::uint8_t>(protocol::kFlagKey | (jumped ? protocol::kFlagDiscontinuity : 0) |
                                           (show.moving ? 0 : protocol::kFlagLast));
  header.sequence = sequence_++;
  header.media_us = media_us(show.time_s);
  header.server_us = at_us;
  header.revision = static_cast<std::uint32_t>(revision);
  header.payload_bytes = static_cast<std::uint32_t>(making_->payload_bytes().size());
  continuity_ = show.continuity;
  revision_ = revision;
  settled_ = !show.moving;
  last_at_us_ = at_us;
  evaluated_serial_ = view_->serial;
  evaluating_ = true;
  busy_self_ = shared_from_this();
  environment_.workers.post([this] { evaluate_on_worker(); });
}

void Producer::evaluate_on_worker() {
  const std::span<float> out(making_->payload);
  const std::size_t half = out.size() / 2;
  const stage::ActorShow& show = making_show_;
  // The lengths are right by construction: there is nothing to fail.
  static_cast<void>(model::sample_vertices(*show.actor, *show.clip, show.time_s, {out.first(half), out.subspan(half), {}}));
  boost::asio::post(environment_.strand, [this] { finished(); });
}

void Producer::finished() {
  const std::shared_ptr<Producer> self = std::move(busy_self_);  // may be the last to hold this, once it returns
  evaluating_ = false;
  latest_ = std::move(making_);
  making_show_ = {};
  tweend::add(environment_.metrics.packets_produced_total);
  environment_.mailbox.put({latest_, subscriptions_});
  delivered_serial_ = evaluated_serial_;
  environment_.progressed();
  schedule();
}

}  // namespace tweend::streams
