#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/base/metrics.hpp"
#include "server/base/worker_pool.hpp"
#include "server/commands/peer.hpp"
#include "server/stage/stage.hpp"
#include "server/streams/hub.hpp"
#include "server/streams/recorder.hpp"

namespace tweend::commands {

/// Tells subscribers what has happened: each notification is printed once and shared by all of them.
///
/// The stage speaks to it on its strand; the list of subscribers lives on the network thread.
class EventHub final : public stage::StageListener {
 public:
  EventHub(streams::Hub& hub, streams::Recorder& recorder, Post to_network, Metrics& metrics);

  // Network thread:
  void subscribe(const std::string& scene, const std::shared_ptr<Peer>& peer);
  void unsubscribe(const std::string& scene, const Peer* peer);
  void forget(const Peer* peer);
  /// Whether anybody listens, if that has changed since it was asked last: for Stage::set_audience().
  [[nodiscard]] std::optional<bool> audience_change();

  // Any thread:
  /// How much of an asset has been read that a new actor is to show, 0 to 1.
  void importing(const std::string& scene, const std::string& actor, const std::string& asset, double fraction);

  // Strand (StageListener):
  void published(const std::string& scene, const stage::SceneViewPtr& view) override;
  void edited(const stage::EditEvent& event) override;
  void players_changed(const stage::SceneViewPtr& view, const std::vector<std::size_t>& concerned, ClockUs now_us) override;
  void player_ended(const stage::SceneViewPtr& view, std::size_t player) override;
  void markers_crossed(const std::string& scene, const std::vector<stage::MarkerCrossed>& crossed) override;
  void schedule_failed(const stage::Scheduled& scheduled, const Error& error) override;

 private:
  enum class Order { AtOnce, AfterPackets };
  using Texts = std::vector<std::shared_ptr<const std::string>>;
  void tell(std::string scene, std::string json, Order order);
  void tell_all(std::string scene, Texts texts, Order order);

  streams::Hub& hub_;
  streams::Recorder& recorder_;
  Post to_network_;
  Metrics& metrics_;
  std::map<std::string, std::vector<std::weak_ptr<Peer>>> subscribers_;  ///< by scene
  bool had_audience_ = false;
};

}  // namespace tweend::commands
