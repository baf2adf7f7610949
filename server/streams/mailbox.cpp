#include "server/streams/mailbox.hpp"

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
  }
  for (const Entry& entry : draining_) {
    if (entry.task) entry.task();
    if (!entry.delivery.packet) continue;
    for (const Subscription& s : *entry.delivery.to) {
      if (const auto sink = s.sink.lock()) sink->offer(s.stream, entry.delivery.packet);
    }
  }
  draining_.clear();
}

}  // namespace tweend::streams
