#include "server/commands/event_hub.hpp"

#include <algorithm>
#include <utility>

#include "protocol/envelope.hpp"
#include "server/commands/wire_types.hpp"

namespace tweend::commands {
namespace {

struct PlaybackChanged {
  static constexpr std::string_view kName = "PlaybackChanged";
  std::string scene;
  std::vector<PlayerState> players;
  std::int64_t server_time_us = 0;
  static void describe(FieldList<PlaybackChanged>& f) {
    using T = PlaybackChanged;
    f.add<&T::scene>("scene", "Its name.");
    f.add<&T::players>("players", "The players concerned.");
    f.add<&T::server_time_us>("server_time_us", "The reading at which these times hold.");
  }
};

struct PlaybackEnded {
  static constexpr std::string_view kName = "PlaybackEnded";
  std::string scene, actor, clip;
  static void describe(FieldList<PlaybackEnded>& f) {
    using T = PlaybackEnded;
    f.add<&T::scene>("scene", "Its name.");
    f.add<&T::actor>("actor", "Whose player has run out.");
    f.add<&T::clip>("clip", "The clip it was on.");
  }
};

struct SceneChanged {
  static constexpr std::string_view kName = "SceneChanged";
  std::string scene;
  std::uint64_t revision = 0;
  std::string method;
  std::optional<std::string> actor, clip;
  std::optional<std::int64_t> keyframe;
  static void describe(FieldList<SceneChanged>& f) {
    using T = SceneChanged;
    f.add<&T::scene>("scene", "Its name.");
    f.add<&T::revision>("revision", "The scene's new revision.");
    f.add<&T::method>("method", "The edit.");
    f.add<&T::actor>("actor", "What it was about.");
    f.add<&T::clip>("clip", "What it was about.");
    f.add<&T::keyframe>("keyframe", "What it was about.");
  }
};

struct AssetProgress {
  static constexpr std::string_view kName = "AssetProgress";
  std::string scene, actor, asset;
  double fraction = 0.0;
  static void describe(FieldList<AssetProgress>& f) {
    using T = AssetProgress;
    f.add<&T::scene>("scene", "Its name.");
    f.add<&T::actor>("actor", "The actor that is to be.");
    f.add<&T::asset>("asset", "What is read for it.");
    f.add<&T::fraction>("fraction", "How much of it is done, 0 to 1.");
  }
};

struct MarkerCrossed {
  static constexpr std::string_view kName = "MarkerCrossed";
  std::string scene, actor, clip;
  std::int64_t marker = 0;
  std::string name;
  double time = 0.0;
  std::int64_t at_us = 0;
  static void describe(FieldList<MarkerCrossed>& f) {
    using T = MarkerCrossed;
    f.add<&T::scene>("scene", "Its name.");
    f.add<&T::actor>("actor", "Whose player has passed it.");
    f.add<&T::clip>("clip", "The clip it is in.");
    f.add<&T::marker>("marker", "Its id.");
    f.add<&T::name>("name", "Its name.");
    f.add<&T::time>("time", "Where it is in the clip, media seconds.");
    f.add<&T::at_us>("at_us", "The first reading at which it was reached.");
  }
};

struct ScheduleFailed {
  static constexpr std::string_view kName = "ScheduleFailed";
  std::string scene;
  std::int64_t scheduled = 0;
  std::string method;
  protocol::JsonText error;
  static void describe(FieldList<ScheduleFailed>& f) {
    using T = ScheduleFailed;
    f.add<&T::scene>("scene", "Its name.");
    f.add<&T::scheduled>("scheduled", "The id that its answer told.");
    f.add<&T::method>("method", "The command.");
    f.add<&T::error>("error", "Why nothing has changed, as an answer would have it.");
  }
};

template <class T>
std::string notification(std::string_view method, const T& params) {
  return protocol::notification_json(method, protocol::encode(params));
}

}  // namespace

EventHub::EventHub(streams::Hub& hub, streams::Recorder& recorder, Post to_network, Metrics& metrics)
    : hub_(hub), recorder_(recorder), to_network_(std::move(to_network)), metrics_(metrics) {}

void EventHub::subscribe(const std::string& scene, const std::shared_ptr<Peer>& peer) {
  unsubscribe(scene, peer.get());  // once is enough
  subscribers_[scene].push_back(peer);
}

void EventHub::unsubscribe(const std::string& scene, const Peer* peer) {
  const auto at = subscribers_.find(scene);
  if (at == subscribers_.end()) return;
  std::erase_if(at->second, [peer](const std::weak_ptr<Peer>& p) { return p.expired() || p.lock().get() == peer; });
  if (at->second.empty()) subscribers_.erase(at);
}

void EventHub::forget(const Peer* peer) {
  for (auto& [scene, peers] : subscribers_) {
    std::erase_if(peers, [peer](const std::weak_ptr<Peer>& p) { return p.expired() || p.lock().get() == peer; });
  }
  std::erase_if(subscribers_, [](const auto& entry) { return entry.second.empty(); });
}

std::optional<bool> EventHub::audience_change() {
  const bool has = !subscribers_.empty();
  if (has == had_audience_) return std::nullopt;
  had_audience_ = has;
  return has;
}

void EventHub::tell(std::string scene, std::string json, Order order) {
  tell_all(std::move(scene), {std::make_shared<const std::string>(std::move(json))}, order);
}

void EventHub::tell_all(std::string scene, Texts texts, Order order) {
  to_network_([this, scene = std::move(scene), texts = std::move(texts), order] {
    const auto at = subscribers_.find(scene);
    if (at == subscribers_.end()) return;
    for (const std::weak_ptr<Peer>& weak : at->second) {
      const auto peer = weak.lock();
      if (!peer) continue;
      add(metrics_.events_total, static_cast<std::int64_t>(texts.size()));
      for (const auto& text : texts) {
        order == Order::AfterPackets ? peer->send_after_packets(text) : peer->send_shared(text);
      }
    }
  });
}

void EventHub::importing(const std::string& scene, const std::string& actor, const std::string& asset, double fraction) {
  tell(scene, notification("asset.progress", AssetProgress{scene, actor, asset, fraction}), Order::AtOnce);
}

void EventHub::published(const std::string& scene, const stage::SceneViewPtr& view) {
  hub_.follow(scene, view);
  recorder_.follow(scene, view);
}

void EventHub::edited(const stage::EditEvent& e) {
  tell(e.scene,
       notification("scene.changed",
                    SceneChanged{e.scene, e.revision, e.method, e.subject.actor, e.subject.clip, e.subject.keyframe}),
       Order::AtOnce);
}

void EventHub::players_changed(const stage::SceneViewPtr& view, const std::vector<std::size_t>& concerned, ClockUs now_us) {
  PlayersResult players = players_result(*view, concerned, now_us);
  tell(view->scene->name,
       notification("playback.changed", PlaybackChanged{view->scene->name, std::move(players.players), now_us}), Order::AtOnce);
}

void EventHub::player_ended(const stage::SceneViewPtr& view, std::size_t player) {
  const stage::Player& p = (*view->players)[player];
  std::string json = notification("playback.ended", PlaybackEnded{view->scene->name, p.actor, p.clip});
  // It says that the final value has been sent: first the packets that show it, then the word.
  hub_.after_delivery(view, [this, scene = view->scene->name, json = std::move(json)]() mutable {
    tell(std::move(scene), std::move(json), Order::AfterPackets);
  });
}

void EventHub::markers_crossed(const std::string& scene, const std::vector<stage::MarkerCrossed>& crossed) {
  Texts texts;
  texts.reserve(crossed.size());
  for (const stage::MarkerCrossed& c : crossed) {
    texts.push_back(std::make_shared<const std::string>(notification(
        "marker.crossed", MarkerCrossed{scene, c.actor, c.clip, c.marker.id, c.marker.name, c.marker.time_s, c.at_us})));
  }
  tell_all(scene, std::move(texts), Order::AtOnce);
}

void EventHub::schedule_failed(const stage::Scheduled& what, const Error& error) {
  protocol::JsonText text{std::make_shared<const std::string>(protocol::error_json(error))};
  tell(what.scene, notification("schedule.failed", ScheduleFailed{what.scene, what.id, what.method, std::move(text)}),
       Order::AtOnce);
}

}  // namespace tweend::commands
