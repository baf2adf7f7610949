#include "server/streams/hub.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "server/streams/actor_content.hpp"
#include "server/streams/frame_content.hpp"

namespace tweend::streams {
namespace {

/// Who asks for fewer packets a second than this hears of an end before seeing it: others are not kept waiting.
constexpr double kSlowRate = 5.0;

}  // namespace

Hub::Hub(stage::Stage& stage, WorkerPool& workers, render::RenderThread& renderer, Post deliver, Metrics& metrics)
    : stage_(stage),
      workers_(workers),
      desk_(stage.strand(), workers, renderer),
      mailbox_(std::move(deliver), metrics),
      metrics_(metrics) {}

Hub::Producers::iterator Hub::find(const StreamKey& key) {
  return std::find_if(producers_.begin(), producers_.end(), [&key](const auto& p) { return p->key() == key; });
}

std::shared_ptr<Producer> Hub::make_producer(const StreamKey& key) {
  ++last_source_;
  const Producer::Environment environment{
      stage_.strand(), mailbox_, metrics_, [this] { progressed(); }, [this] { drop_idle(); }, meters_.meter(labels_of(key))};
  return std::make_shared<Producer>(key, last_source_, environment, [&](ContentOwner& owner) -> std::shared_ptr<Content> {
    if (const auto* frames = std::get_if<FramesSpec>(&key.what)) {
      return std::make_shared<FrameContent>(*frames, key.rate, stage_.strand(), workers_, desk_, owner);
    }
    if (const auto* pose = std::get_if<PoseSpec>(&key.what)) {
      return std::make_shared<PoseContent>(key.scene, *pose, stage_.strand(), workers_, owner);
    }
    return std::make_shared<VerticesContent>(key.scene, std::get<VerticesSpec>(key.what), stage_.strand(), workers_, owner);
  });
}

void Hub::refuse(Subscription subscription, std::string reason) {
  mailbox_.call([subscription = std::move(subscription), reason = std::move(reason)] {
    if (const auto sink = subscription.sink.lock()) sink->ended(subscription.stream, reason);
  });
}

void Hub::subscribe(const StreamKey& key, Subscription subscription) {
  const auto at = find(key);
  if (at != producers_.end()) return (*at)->add(std::move(subscription));
  const stage::SceneViewPtr view = stage_.view()->find(key.scene);
  if (!view) return refuse(std::move(subscription), fmt::format("the scene \"{}\" was removed", key.scene));
  const std::shared_ptr<Producer> producer = make_producer(key);
  if (!producer->follow(view)) return refuse(std::move(subscription), producer->what_is_gone());
  producers_.push_back(producer);
  metrics_.producers = static_cast<std::int64_t>(producers_.size());
  producer->add(std::move(subscription));
}

void Hub::unsubscribe(const StreamKey& key, const PacketSink* sink, std::uint32_t stream) {
  const auto at = find(key);
  if (at == producers_.end()) return;
  (*at)->remove(sink, stream);
  if ((*at)->idle()) drop_idle();
}

void Hub::request_key(const StreamKey& key) {
  if (const auto at = find(key); at != producers_.end()) (*at)->request_key();
}

void Hub::retune(const StreamKey& from, const StreamKey& to, Subscription subscription) {
  const auto held = subscription.sink.lock();
  const auto at = find(from);
  if (at != producers_.end() && (*at)->serves_only(held.get(), subscription.stream) && same_but_view(from, to) &&
      find(to) == producers_.end()) {
    (*at)->retune(to, meters_.meter(labels_of(to)));
    return progressed();  // one that is slow now is waited for no longer
  }
  unsubscribe(from, held.get(), subscription.stream);
  subscribe(to, std::move(subscription));
}

void Hub::follow(const std::string& scene, const stage::SceneViewPtr& view) {
  for (const std::shared_ptr<Producer>& producer : producers_) {
    if (producer->key().scene != scene) continue;
    if (!view) {
      producer->end(fmt::format("the scene \"{}\" was removed", scene));
    } else if (!producer->follow(view)) {
      producer->end(producer->what_is_gone());
    }
  }
  drop_idle();
}

void Hub::drop_idle() {
  const std::size_t dropped = std::erase_if(producers_, [](const std::shared_ptr<Producer>& producer) {
    if (producer->idle()) producer->stop();
    return producer->idle();
  });
  if (dropped > 0) desk_.trim();
  metrics_.producers = static_cast<std::int64_t>(producers_.size());
  progressed();  // nobody waits for a producer that is gone
}

bool Hub::delivered(const Waiter& waiter) const {
  return std::all_of(producers_.begin(), producers_.end(), [&](const std::shared_ptr<Producer>& producer) {
    return producer->key().scene != waiter.scene || producer->key().rate < kSlowRate ||
           producer->delivered_serial() >= waiter.serial;
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
  for (const auto& producer : producers_) producer->stop();
  producers_.clear();
  desk_.stop();
  for (Waiter& w : std::exchange(waiters_, {})) w.then();
}

}  // namespace tweend::streams
