#include "server/streams/mailbox.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace tweend::streams {

void Mailbox::put(Delivery delivery) { append({std::move(delivery), {}}); }

void Mailbox::call(Task task) { append({{}, std::move(task)}); }

void Mailbox::append(Entry entry) {
  bool first = false;
  {
    const std::lock_guard lock(mutex_);
    first = waiting_.empty();
    waiting_.push_back(std::move(entry));
  }
  if (first) post_([this] { drain(); });  // later ones find the task on its way
}

void Mailbox::drain() {
  {
    const std::lock_guard lock(mutex_);
    draining_.swap(waiting_);
    drains_.fetch_add(1, std::memory_order_relaxed);
  }
  const ClockUs now_us = steady_now_us();
  for (const Entry& entry : draining_) {
    if (entry.delivery.packet && !entry.delivery.again) measure(entry.delivery, now_us);
  }
  for (std::size_t i = 0; i < draining_.size();) {
    if (draining_[i].task) draining_[i].task();
    i = draining_[i].delivery.packet ? offer_run(i) : i + 1;
  }
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  for (const std::shared_ptr<PacketSink>& sink : touched_) sink->flush();
  touched_.clear();
  draining_.clear();
}

void Mailbox::measure(const Delivery& delivery, ClockUs now_us) {
  const ClockUs delay_us = std::max<ClockUs>(0, now_us - delivery.packet->header.server_us);
  metrics_.packet_delay_seconds.observe(delay_us);
  const ClockUs before_us = delivery.packet->exchange_delay(delay_us);
  if (before_us >= 0) metrics_.packet_jitter_seconds.observe(std::abs(delay_us - before_us));
}

/// Offers the packets from `begin` on that go to the same list, sink by sink: each is looked up and warmed up once.
/// @return where the next list, or a call, is
std::size_t Mailbox::offer_run(std::size_t begin) {
  const Subscriptions* const to = draining_[begin].delivery.to.get();
  std::size_t end = begin + 1;
  while (end < draining_.size() && draining_[end].delivery.to.get() == to && draining_[end].delivery.packet) ++end;
  const bool only = begin == 0 && end == draining_.size();
  for (const Subscription& s : *to) {
    std::shared_ptr<PacketSink> sink = s.sink.lock();
    if (!sink) continue;
    for (std::size_t i = begin; i < end; ++i) sink->offer(s.stream, draining_[i].delivery.packet);
    if (only) {
      sink->flush();  // nothing more comes for it, and its memory is warm
    } else {
      touched_.push_back(std::move(sink));
    }
  }
  return end;
}

}  // namespace tweend::streams
