#pragma once

#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/base/clock.hpp"
#include "server/base/metrics.hpp"
#include "server/stage/show.hpp"
#include "server/streams/content.hpp"
#include "server/streams/mailbox.hpp"
#include "server/streams/packet.hpp"
#include "server/streams/packet_sink.hpp"
#include "server/streams/stream_key.hpp"

namespace tweend::streams {

/// Makes the packets of one content at one rate, for whoever has subscribed.
///
/// Lives on the stage's strand; the content is made elsewhere, in steps, one packet at a time in each. While it moves, packets
/// leave on a grid of readings that all producers of a rate share (k / rate by the clock, so that lateness never adds up and
/// what two of them need of a moment is made once); a reading at which the first step is still at work is missed, never queued.
/// While nothing changes, nothing is sent: the packet that shows a final state carries flag 4, and the timer sleeps. On a lower
/// rung of the ladder that packet comes half a second later, as good as was asked for.
///
/// Where packets need the ones before them, keys come with the first packet, jumps, final states, once a second, and soon after
/// somebody needs one.
class Producer final : public ContentOwner, public std::enable_shared_from_this<Producer> {
 public:
  struct Environment {
    boost::asio::io_context& strand;
    Mailbox& mailbox;  ///< to the sinks' thread
    Metrics& metrics;
    std::function<void()> progressed;  ///< on the strand, after each delivery
    std::function<void()> ended;       ///< on the strand: it can't be made, and the subscribers have been told
    std::shared_ptr<StreamMeter> meter = std::make_shared<StreamMeter>();
  };
  using MakeContent = std::function<std::shared_ptr<Content>(ContentOwner& owner)>;

  Producer(StreamKey key, std::uint64_t source, Environment environment, const MakeContent& make_content);

  [[nodiscard]] const StreamKey& key() const noexcept { return key_; }
  [[nodiscard]] bool idle() const noexcept { return subscriptions_->empty(); }
  /// Whether this stream of this sink is the only one.
  [[nodiscard]] bool serves_only(const PacketSink* sink, std::uint32_t stream) const noexcept;
  /// The newest view that a delivered packet shows.
  [[nodiscard]] std::uint64_t delivered_serial() const noexcept { return delivered_serial_; }

  /// A packet is made for the first one; later ones get the latest there is, or soon a key. The others are sent nothing more
  /// for that.
  void add(Subscription subscription);
  void remove(const PacketSink* sink, std::uint32_t stream);
  /// The scene has a new view; the first one before anything else. False: what was shown is gone.
  [[nodiscard]] bool follow(const stage::SceneViewPtr& view);
  /// The next packet is to decode on its own; one is made soon where there would be none. Keys that were asked for are a
  /// quarter of a second apart.
  void request_key();
  /// Goes on with another rate or camera.
  void retune(StreamKey key);
  /// Tells all subscribers and forgets them.
  void end(const std::string& reason);
  /// What follow() said no to, for the clients.
  [[nodiscard]] std::string what_is_gone() const { return content_->what_is_gone(); }
  void stop();

  // ContentOwner
  void ready() override;
  void made(Result<NewPacketPtr> packet) override;

 private:
  [[nodiscard]] double period_us() const noexcept;
  /// The number of the grid's last reading that is past.
  [[nodiscard]] std::int64_t reading_before(ClockUs now_us) const noexcept;
  [[nodiscard]] bool changed() const noexcept { return begun_serial_ != view_->serial; }
  [[nodiscard]] bool on_lower_rung() const noexcept;
  [[nodiscard]] bool needs_key(bool jumped, bool moving, ClockUs at_us) const noexcept;
  void schedule();
  [[nodiscard]] ClockUs next_reading_us(ClockUs now_us);
  void wait_until(ClockUs at_us);
  void tick(ClockUs at_us);
  void begin(ClockUs at_us);
  void replace(Subscriptions next);
  void measure(ClockUs at_us);

  StreamKey key_;
  const std::uint64_t source_;  ///< tells this producer's packets from others'
  Environment environment_;
  const std::shared_ptr<Content> content_;
  boost::asio::steady_timer timer_;
  const std::shared_ptr<PacketPool> pool_;
  // Replaced as a whole, so that a delivery under way keeps the list it began with.
  std::shared_ptr<const Subscriptions> subscriptions_ = std::make_shared<const Subscriptions>();
  stage::SceneViewPtr view_;
  PacketPtr latest_;
  std::shared_ptr<Producer> busy_self_;  ///< set while a packet is in the making
  std::size_t in_making_ = 0;
  NewPacketPtr newest_;             ///< the one begun last, while it is in the making
  std::uint64_t begun_serial_ = 0;  ///< of the newest view that a packet was begun for
  std::uint64_t delivered_serial_ = 0;
  std::uint64_t continuity_ = 0;
  std::uint64_t revision_ = 0;
  std::uint32_t sequence_ = 0;
  ClockUs last_at_us_ = 0;
  ClockUs last_key_us_ = 0;
  std::optional<ClockUs> last_delay_us_;  ///< from its reading to its being handed over, of the packet before
  std::int64_t last_reading_ = 0;         ///< of the grid, by number
  bool key_wanted_ = false;
  bool settled_ = false;  ///< what the last packet begun shows stays, until something changes
  bool refined_ = false;  ///< and it is as good as was asked for
  bool busy_ = false;     ///< the content takes no other packet yet
  bool scheduled_ = false;
  bool unhurried_ = false;  ///< what it is scheduled for is no change, and gives way to one
};

}  // namespace tweend::streams
