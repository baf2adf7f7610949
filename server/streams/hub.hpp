#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/render_thread.hpp"
#include "server/base/metrics.hpp"
#include "server/base/worker_pool.hpp"
#include "server/stage/stage.hpp"
#include "server/streams/picture_desk.hpp"
#include "server/streams/producer.hpp"
#include "server/streams/stream_meter.hpp"

namespace tweend::streams {

/// Who shares what: one producer for each set of parameters that somebody has subscribed to.
/// Public functions run on the stage's strand (post to it) unless they say otherwise.
class Hub {
 public:
  /// @param deliver  posts to the thread on which sinks are called
  Hub(stage::Stage& stage, WorkerPool& workers, render::RenderThread& renderer, Post deliver, Metrics& metrics);

  /// The first packet follows at once. An actor that has gone meanwhile ends the stream.
  void subscribe(const StreamKey& key, Subscription subscription);
  void unsubscribe(const StreamKey& key, const PacketSink* sink, std::uint32_t stream);
  /// Somebody needs a packet that decodes on its own.
  void request_key(const StreamKey& key);
  /// A stream goes on with another rate, camera or rung. A viewer that nobody else looks with takes its producer along: a
  /// camera that is dragged starts none anew.
  void retune(const StreamKey& from, const StreamKey& to, Subscription subscription);

  /// The stage has published a view (null: the scene is gone).
  void follow(const std::string& scene, const stage::SceneViewPtr& view);
  /// Calls `then` once every producer of the scene has delivered a packet that shows `view` or a later one; those of less than
  /// five packets a second are not waited for.
  void after_delivery(const stage::SceneViewPtr& view, std::function<void()> then);
  /// Ends all producers, before the strand stops.
  void stop();

  /// What has become of each producer's packets. Any thread.
  [[nodiscard]] const StreamMeters& meters() const noexcept { return meters_; }

 private:
  struct Waiter {
    std::string scene;
    std::uint64_t serial;
    std::function<void()> then;
  };
  using Producers = std::vector<std::shared_ptr<Producer>>;
  [[nodiscard]] Producers::iterator find(const StreamKey& key);
  [[nodiscard]] std::shared_ptr<Producer> make_producer(const StreamKey& key);
  void refuse(Subscription subscription, std::string reason);
  void progressed();
  [[nodiscard]] bool delivered(const Waiter& waiter) const;
  void drop_idle();

  stage::Stage& stage_;
  WorkerPool& workers_;
  PictureDesk desk_;
  Mailbox mailbox_;
  Metrics& metrics_;
  StreamMeters meters_;
  Producers producers_;
  std::vector<Waiter> waiters_;
  std::uint64_t last_source_ = 0;
};

}  // namespace tweend::streams
