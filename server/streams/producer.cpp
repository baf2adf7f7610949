#include "server/streams/producer.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cmath>
#include <utility>

#include "server/stage/player.hpp"

namespace tweend::streams {
namespace {

/// Keys are at most so far apart; those that were asked for at least.
constexpr double kKeyEveryUs = 1e6;
constexpr ClockUs kKeySpacingUs = 250'000;
/// How long something stands still before it is worth a better picture.
constexpr ClockUs kRefineAfterUs = 500'000;
/// Packets that may wait for the sinks' thread: an eighth of a second at 60 a second, which a busy thread makes up for.
constexpr std::size_t kMostUndelivered = 8;

std::int64_t media_us(double time_s) noexcept { return std::llround(time_s * 1e6); }

}  // namespace

Producer::Producer(StreamKey key, std::uint64_t source, Environment environment, const MakeContent& make_content)
    : key_(std::move(key)),
      source_(source),
      environment_(std::move(environment)),
      content_(make_content(*this)),
      timer_(environment_.strand),
      pool_(std::make_shared<PacketPool>(environment_.meter)) {}

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
  if (unhurried_ && changed()) timer_.cancel();  // which schedules anew
  schedule();
  return true;
}

void Producer::retune(StreamKey key, std::shared_ptr<StreamMeter> meter) {
  key_ = std::move(key);
  if (meter != environment_.meter) {
    const auto readers = static_cast<std::int64_t>(readers_.size());
    tweend::add(environment_.meter->readers, -readers);
    tweend::add(meter->readers, readers);
    environment_.meter = std::move(meter);
    pool_ = std::make_shared<PacketPool>(environment_.meter);
  }
  content_->look_from(key_);
  begun_serial_ = 0;  // nothing shows it so yet
  last_reading_ = reading_before(steady_now_us());
  timer_.cancel();  // which schedules anew
  schedule();
}

bool Producer::serves_only(const PacketSink* sink, std::uint32_t stream) const noexcept {
  return readers_.size() == 1 && readers_[0].sink == sink && readers_[0].subscription.stream == stream;
}

void Producer::readers_changed(std::int64_t by) {
  tweend::add(environment_.meter->readers, by);
  subscriptions_.reset();
}

const std::shared_ptr<const Subscriptions>& Producer::subscriptions() {
  if (!subscriptions_) {
    Subscriptions list;
    list.reserve(readers_.size());
    for (const Reader& reader : readers_) list.push_back(reader.subscription);
    subscriptions_ = std::make_shared<const Subscriptions>(std::move(list));
  }
  return subscriptions_;
}

void Producer::add(Subscription subscription) {
  readers_.push_back({subscription.sink.lock().get(), subscription});
  readers_changed(1);
  if (latest_ && (latest_->header.flags & protocol::kFlagKey) != 0) {  // whatever has changed since is on its way to all
    environment_.mailbox.put({latest_, std::make_shared<const Subscriptions>(Subscriptions{std::move(subscription)}), true});
  } else if (!settled_) {
    key_wanted_ = true;
  }
  schedule();
}

void Producer::request_key() {
  key_wanted_ = true;
  schedule();
}

void Producer::remove(const PacketSink* sink, std::uint32_t stream) {
  // Whoever takes a subscription back still holds the sink: no other has its address.
  const auto at = std::find_if(readers_.begin(), readers_.end(), [&](const Reader& reader) {
    return reader.sink == sink && reader.subscription.stream == stream;
  });
  if (at == readers_.end()) return;
  *at = std::move(readers_.back());
  readers_.pop_back();
  readers_changed(-1);
}

void Producer::end(const std::string& reason) {
  newest_.reset();
  environment_.mailbox.call([to = subscriptions(), reason] {
    for (const Subscription& s : *to) {
      if (const auto sink = s.sink.lock()) sink->ended(s.stream, reason);
    }
  });
  stop();
}

void Producer::stop() {
  timer_.cancel();
  readers_changed(-static_cast<std::int64_t>(readers_.size()));
  readers_.clear();
}

double Producer::period_us() const noexcept {
  constexpr double kLongestUs = 1e15;  // decades: what the clock can still count
  return std::min(1e6 / key_.rate, kLongestUs);
}

std::int64_t Producer::reading_before(ClockUs now_us) const noexcept {
  return static_cast<std::int64_t>(std::floor(static_cast<double>(now_us) / period_us()));
}

bool Producer::on_lower_rung() const noexcept {
  const auto* frames = std::get_if<FramesSpec>(&key_.what);
  return frames != nullptr && frames->rung > 0;
}

void Producer::schedule() {
  if (scheduled_ || busy_ || idle()) return;
  const ClockUs now_us = steady_now_us();
  unhurried_ = settled_ && !changed();
  if (!unhurried_) {
    wait_until(next_reading_us(now_us));
  } else if (key_wanted_) {
    wait_until(std::max(now_us, last_key_us_ + kKeySpacingUs));
  } else if (!refined_) {
    wait_until(std::max(now_us, last_at_us_ + kRefineAfterUs));
  }
}

ClockUs Producer::next_reading_us(ClockUs now_us) {
  const double period_us = this->period_us();
  // The next reading of the grid; a change after a pause, and the very first packet, need no grid to wait for.
  const std::int64_t reading = reading_before(now_us) + 1;
  const bool at_once = changed() && (sequence_ == 0 || static_cast<double>(now_us - last_at_us_) >= period_us);
  if (sequence_ != 0 && !settled_) {
    tweend::add(environment_.metrics.ticks_missed_total, std::max<std::int64_t>(0, reading - last_reading_ - 1));
  }
  last_reading_ = at_once ? reading - 1 : reading;
  return at_once ? now_us : static_cast<ClockUs>(static_cast<double>(reading) * period_us);
}

void Producer::wait_until(ClockUs at_us) {
  scheduled_ = true;
  timer_.expires_at(instant(at_us));
  timer_.async_wait([self = shared_from_this(), at_us](const boost::system::error_code& error) {
    self->scheduled_ = false;
    if (error) return self->schedule();  // something has changed; or stopped, and then idle
    if (!self->idle()) self->tick(at_us);
  });
}

void Producer::tick(ClockUs at_us) {
  if (sinks_are_behind()) return miss();
  const ClockUs now_us = steady_now_us();
  // The machine was away: show now, not then. And never a playhead at a reading before it was set.
  if (static_cast<double>(now_us - at_us) >= 1e6 / key_.rate) at_us = now_us;
  begin(std::max(at_us, content_->earliest_us()));
}

bool Producer::sinks_are_behind() const noexcept {
  return undelivered_ >= kMostUndelivered && environment_.mailbox.drains() == drains_;
}

void Producer::miss() {
  // The next reading even for what would be shown at once: while the sinks' thread stands still, asking again costs little.
  // Nothing was begun, so nothing is missing from the packets' numbers.
  tweend::add(environment_.metrics.ticks_missed_total);
  last_reading_ = reading_before(steady_now_us()) + 1;
  wait_until(static_cast<ClockUs>(static_cast<double>(last_reading_) * period_us()));
}

bool Producer::needs_key(bool jumped, bool moving, ClockUs at_us) const noexcept {
  if (!content_->chained() || sequence_ == 0 || jumped || !moving) return true;
  const ClockUs since_us = at_us - last_key_us_;
  return static_cast<double>(since_us) + period_us() > kKeyEveryUs || (key_wanted_ && since_us >= kKeySpacingUs);
}

void Producer::begin(ClockUs at_us) {
  refined_ = !on_lower_rung() || (settled_ && !changed());
  content_->refine(refined_);
  const ContentReading reading = content_->read(at_us);
  NewPacketPtr packet = pool_->take();
  packet->source = source_;
  packet->view_serial = view_->serial;
  const std::uint64_t revision = view_->scene->revision;
  const bool jumped = sequence_ != 0 && (reading.continuity != continuity_ || revision != revision_);
  const bool key = needs_key(jumped, reading.moving, at_us);
  protocol::PacketHeader& header = packet->header;
  header.flags = static_cast<std::uint8_t>((key ? protocol::kFlagKey : 0) | (jumped ? protocol::kFlagDiscontinuity : 0) |
                                           (reading.moving || !refined_ ? 0 : protocol::kFlagLast));
  header.sequence = sequence_++;
  header.media_us = media_us(reading.time_s);
  header.server_us = at_us;
  header.revision = static_cast<std::uint32_t>(revision);
  if (key) {
    last_key_us_ = at_us;
    key_wanted_ = false;
  }
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
  tweend::add(environment_.meter->produced);
  put({latest_, subscriptions()});
  environment_.progressed();
}

void Producer::put(Delivery delivery) {
  const std::uint64_t drains = environment_.mailbox.drains();
  undelivered_ = std::exchange(drains_, drains) == drains ? undelivered_ + 1 : 1;
  environment_.mailbox.put(std::move(delivery));
}

}  // namespace tweend::streams
