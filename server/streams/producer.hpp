#pragma once

#include <boost/asio/steady_timer.hpp>
#include <compare>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/base/clock.hpp"
#include "server/base/metrics.hpp"
#include "server/base/worker_pool.hpp"
#include "server/stage/show.hpp"
#include "server/streams/mailbox.hpp"
#include "server/streams/packet.hpp"
#include "server/streams/packet_sink.hpp"

namespace tweend::streams {

/// What tells producers apart: streams with equal keys share one.
struct StreamKey {
  std::string scene;
  std::string actor;
  double rate = 30.0;  ///< packets a second
  auto operator<=>(const StreamKey&) const = default;
};

/// Makes the packets of one actor's vertices at one rate, for whoever has subscribed.
///
/// Lives on the stage's strand; evaluates on workers, one evaluation at a time. While the actor moves, packets leave on an
/// absolute grid of readings (start + k / rate); a reading whose predecessor is still in the making is missed, never queued.
/// While nothing changes, nothing is sent: the packet that shows a final state carries flag 4, and the timer sleeps.
class Producer : public std::enable_shared_from_this<Producer> {
 public:
  struct Environment {
    boost::asio::io_context& strand;
    WorkerPool& workers;
    Mailbox& mailbox;  ///< to the sinks' thread
    Metrics& metrics;
    std::function<void()> progressed;  ///< on the strand, after each delivery
  };

  Producer(StreamKey key, std::uint64_t source, stage::SceneViewPtr view, Environment environment);

  [[nodiscard]] const StreamKey& key() const noexcept { return key_; }
  [[nodiscard]] bool idle() const noexcept { return subscriptions_->empty(); }
  /// The newest view that a delivered packet shows.
  [[nodiscard]] std::uint64_t delivered_serial() const noexcept { return delivered_serial_; }

  /// A packet is evaluated for the first one; later ones get the latest there is. The others are sent nothing.
  void add(Subscription subscription);
  void remove(const PacketSink* sink, std::uint32_t stream);
  /// The scene has a new view. False: the actor is gone, or has become another model.
  [[nodiscard]] bool follow(stage::SceneViewPtr view);
  /// Tells all subscribers and forgets them.
  void end(const std::string& reason);
  void stop();

 private:
  [[nodiscard]] bool shows_the_same(const stage::SceneView& next, std::size_t actor) const noexcept;
  void schedule();
  void tick(ClockUs at_us);
  void evaluate(ClockUs at_us);
  void evaluate_on_worker();
  void finished();
  [[nodiscard]] stage::ActorShow show(ClockUs at_us) const noexcept;

  const StreamKey key_;
  const std::uint64_t source_;  ///< tells this producer's packets from others'
  Environment environment_;
  const ClockUs start_us_;
  boost::asio::steady_timer timer_;
  std::shared_ptr<PacketPool> pool_ = std::make_shared<PacketPool>();
  // Replaced as a whole, so that a delivery under way keeps the list it began with.
  std::shared_ptr<const Subscriptions> subscriptions_ = std::make_shared<const Subscriptions>();
  stage::SceneViewPtr view_;
  std::size_t actor_ = 0;  ///< its index in the view
  PacketPtr latest_;
  // The evaluation under way, handed to a worker and back. Members and not a closure: nothing is allocated for a packet.
  boost::intrusive_ptr<Packet> making_;
  stage::ActorShow making_show_;
  std::shared_ptr<Producer> busy_self_;  ///< set while a worker is at it
  std::uint64_t evaluated_serial_ = 0;
  std::uint64_t delivered_serial_ = 0;
  std::uint64_t continuity_ = 0;
  std::uint64_t revision_ = 0;
  std::uint32_t sequence_ = 0;
  ClockUs last_at_us_ = 0;
  std::int64_t last_reading_ = 0;  ///< of the grid, by number
  bool settled_ = false;           ///< the last packet evaluated was the last of its cause
  bool evaluating_ = false;
  bool scheduled_ = false;
};

}  // namespace tweend::streams
