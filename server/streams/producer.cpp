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

Producer::Producer(StreamKey key, std::uint64_t source, Environment environment, const MakeContent& make_content)
    : key_(std::move(key)),
      source_(source),
      environment_(std::move(environment)),
      content_(make_content(*this)),
      start_us_(steady_now_us()),
      timer_(environment_.strand) {}

bool Producer::follow(const stage::SceneViewPtr& view) {
  if (view_ && begun_serial_ == view_->serial && content_->shows_the_same(*view)) {
    // Something else has changed: what has been sent, or is in the making, is as good for the new view.
    begun_serial_ = view->serial;
    if (newest_) {
      newest_->view_serial = view->serial;
    } else {
      delivered_serial_ = view->serial;
    }
  }
  if (!content_->follow(view)) return false;
  view_ = view;
  if (!idle()) schedule();
  return true;
}

void Producer::retune(StreamKey key) {
  key_ = std::move(key);
  content_->look_from(key_);
  begun_serial_ = 0;  // nothing shows it so yet
  timer_.cancel();    // which schedules anew
  schedule();
}

bool Producer::serves_only(const PacketSink* sink, std::uint32_t stream) const noexcept {
  if (subscriptions_->size() != 1) return false;
  const Subscription& only = subscriptions_->front();
  return only.stream == stream && only.sink.lock().get() == sink;
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
  newest_.reset();
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
  if (scheduled_ || busy_ || idle()) return;
  const bool changed = begun_serial_ != view_->serial;
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
    if (error) return self->schedule();  // retuned; or stopped, and then idle
    if (!self->idle()) self->tick(at_us);
  });
}

void Producer::tick(ClockUs at_us) {
  const ClockUs now_us = steady_now_us();
  // The machine was away: show now, not then. And never a playhead at a reading before it was set.
  if (static_cast<double>(now_us - at_us) >= 1e6 / key_.rate) at_us = now_us;
  begin(std::max(at_us, content_->earliest_us()));
}

void Producer::begin(ClockUs at_us) {
  const ContentReading reading = content_->read(at_us);
  NewPacketPtr packet = pool_->take();
  packet->source = source_;
  packet->view_serial = view_->serial;
  const std::uint64_t revision = view_->scene->revision;
  const bool jumped = sequence_ != 0 && (reading.continuity != continuity_ || revision != revision_);
  protocol::PacketHeader& header = packet->header;
  header.flags = static_cast<std::uint8_t>(protocol::kFlagKey | (jumped ? protocol::kFlagDiscontinuity : 0) |
                                           (reading.moving ? 0 : protocol::kFlagLast));
  header.sequence = sequence_++;
  header.media_us = media_us(reading.time_s);
  header.server_us = at_us;
  header.revision = static_cast<std::uint32_t>(revision);
  continuity_ = reading.continuity;
  revision_ = revision;
  settled_ = !reading.moving;
  last_at_us_ = at_us;
  begun_serial_ = view_->serial;
  busy_ = true;
  busy_self_ = shared_from_this();
  ++in_making_;
  newest_ = packet;
  content_->begin(std::move(packet), at_us + static_cast<ClockUs>(std::min(1e6 / key_.rate, 1e6)));
}

void Producer::ready() {
  busy_ = false;
  schedule();
}

void Producer::made(Result<NewPacketPtr> packet) {
  const std::shared_ptr<Producer> self = busy_self_;  // may be the last to hold this, once it returns
  if (--in_making_ == 0) busy_self_.reset();
  if (!packet) {
    end(packet.error().message);
    return environment_.ended();
  }
  if (newest_ == *packet) newest_.reset();
  protocol::PacketHeader& header = (*packet)->header;
  header.payload_bytes = static_cast<std::uint32_t>((*packet)->payload.bytes().size());
  delivered_serial_ = (*packet)->view_serial;
  latest_ = std::move(*packet);
  tweend::add(environment_.metrics.packets_produced_total);
  environment_.mailbox.put({latest_, subscriptions_});
  environment_.progressed();
}

}  // namespace tweend::streams
