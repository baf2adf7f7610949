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
  actor_ = static_cast<std::size_t>(at - actors.begin());
  view_ = std::move(view);
  if (!idle()) schedule();
  return true;
}

stage::ActorShow Producer::show(ClockUs at_us) const noexcept {
  return stage::show_actor(view_->scene->actors[actor_], (*view_->players)[actor_], at_us);
}

void Producer::add(Subscription subscription) {
  auto next = std::make_shared<Subscriptions>(*subscriptions_);
  next->push_back(subscription);
  subscriptions_ = std::move(next);
  // The latest packet is as good as new, unless this producer slept through a change before anybody came back.
  if (latest_ && (evaluating_ || evaluated_serial_ == view_->serial)) {
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
  const double period_us = 1e6 / key_.rate;
  // The next reading of the grid, one that has not been used; a change after a pause needs no grid to wait for.
  auto k = static_cast<std::int64_t>(std::floor(static_cast<double>(now_us - start_us_) / period_us)) + 1;
  ClockUs at_us = start_us_ + static_cast<ClockUs>(static_cast<double>(k) * period_us);
  if (changed && static_cast<double>(now_us - last_at_us_) >= period_us) at_us = now_us;
  scheduled_ = true;
  timer_.expires_at(instant(at_us));
  timer_.async_wait([self = shared_from_this(), at_us](const boost::system::error_code& error) {
    self->scheduled_ = false;
    if (!error && !self->idle()) self->tick(at_us);
  });
}

void Producer::tick(ClockUs at_us) {
  const ClockUs now_us = steady_now_us();
  const auto period_us = static_cast<ClockUs>(1e6 / key_.rate);
  if (now_us - at_us >= period_us) {  // the machine was away: show now, not then
    tweend::add(environment_.metrics.ticks_missed_total, (now_us - at_us) / period_us);
    at_us = now_us;
  }
  evaluate(at_us);
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
