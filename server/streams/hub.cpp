#include "server/streams/hub.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace tweend::streams {

Hub::Hub(stage::Stage& stage, WorkerPool& workers, Post deliver, Metrics& metrics)
    : stage_(stage), workers_(workers), mailbox_(std::move(deliver)), metrics_(metrics) {}

void Hub::subscribe(const StreamKey& key, Subscription subscription) {
  const stage::SceneViewPtr view = stage_.view()->find(key.scene);
  if (!view || view->find_player(key.actor) == nullptr) {
    mailbox_.call([subscription = std::move(subscription), key] {
      if (const auto sink = subscription.sink.lock()) {
        sink->ended(subscription.stream, fmt::format("the actor \"{}\" of the scene \"{}\" was removed", key.actor, key.scene));
      }
    });
    return;
  }
  std::shared_ptr<Producer>& producer = producers_[key];
  if (!producer) {
    producer = std::make_shared<Producer>(
        key, ++last_source_, view,
        Producer::Environment{stage_.strand(), workers_, mailbox_, metrics_, [this] { progressed(); }});
    metrics_.producers = static_cast<std::int64_t>(producers_.size());
  }
  producer->add(std::move(subscription));
}

void Hub::unsubscribe(const StreamKey& key, const PacketSink* sink, std::uint32_t stream) {
  const auto at = producers_.find(key);
  if (at == producers_.end()) return;
  at->second->remove(sink, stream);
  if (at->second->idle()) drop_idle();
}

void Hub::follow(const std::string& scene, const stage::SceneViewPtr& view) {
  for (auto& [key, producer] : producers_) {
    if (key.scene != scene) continue;
    if (!view) {
      producer->end(fmt::format("the scene \"{}\" was removed", scene));
    } else if (!producer->follow(view)) {
      producer->end(fmt::format("the actor \"{}\" of the scene \"{}\" was removed", key.actor, scene));
    }
  }
  drop_idle();
}

void Hub::drop_idle() {
  for (auto at = producers_.begin(); at != producers_.end();) {
    if (!at->second->idle()) {
      ++at;
      continue;
    }
    at->second->stop();
    at = producers_.erase(at);
  }
  metrics_.producers = static_cast<std::int64_t>(producers_.size());
  progressed();  // nobody waits for a producer that is gone
}

bool Hub::delivered(const Waiter& waiter) const {
  return std::all_of(producers_.begin(), producers_.end(), [&](const auto& entry) {
    return entry.first.scene != waiter.scene || entry.second->delivered_serial() >= waiter.serial;
  });
}

void Hub::after_delivery(const stage::SceneViewPtr& view, std::function<void()> then) {
  waiters_.push_back({view->scene->name, view->serial, std::move(then)});
  progressed();
}

void Hub::progressed() {
  // In order within a scene: what ended first is told first. Another scene's producers hold nobody up.
  std::set<std::string> blocked;
  for (auto at = waiters_.begin(); at != waiters_.end();) {
    if (blocked.contains(at->scene) || !delivered(*at)) {
      blocked.insert(at->scene);
      ++at;
      continue;
    }
    const auto then = std::move(at->then);
    at = waiters_.erase(at);
    then();
  }
}

void Hub::stop() {
  for (auto& [key, producer] : producers_) producer->stop();
  producers_.clear();
  for (Waiter& w : std::exchange(waiters_, {})) w.then();
}

}  // namespace tweend::streams
