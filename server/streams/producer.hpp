#pragma once

#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <memory>
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
/// what two of them need of a moment is made once); a reading at which the first step is still at work, or packets pile up
/// since the sinks' thread takes none, is missed, never queued. While nothing changes, nothing is sent: the packet that shows a
/// final state carries flag 4, and the timer sleeps. On a lower rung of the ladder that packet comes half a second later, as
/// good as was asked for.
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
  [[nodiscard]] bool idle() const noexcept { return readers_.empty(); }
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
  /// @param meter  what packets are counted by from now on
  void retune(StreamKey key, std::shared_ptr<StreamMeter> meter);
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
  void miss();
  void begin(ClockUs at_us);
  void put(Delivery delivery);
  void readers_changed(std::int64_t by);
  [[nodiscard]] const std::shared_ptr<const Subscriptions>& subscriptions();
  /// Whether packets wait for the sinks' thread, and so many that another would be one more that nobody sees in time.
  [[nodiscard]] bool sinks_are_behind() const noexcept;

  StreamKey key_;
  const std::uint64_t source_;  ///< tells this producer's packets from others'
  Environment environment_;
  const std::shared_ptr<Content> content_;
  boost::asio::steady_timer timer_;
  std::shared_ptr<PacketPool> pool_;
  /// A subscription, and what its sink is told apart by without asking whether it is still there.
  struct Reader {
    const PacketSink* sink;
    Subscription subscription;
  };
  std::vector<Reader> readers_;
  // What deliveries share: the list as it was at the last one, so that many who come or leave at once cost one list. Null: it
  // has changed since.
  std::shared_ptr<const Subscriptions> subscriptions_;
  std::uint64_t drains_ = 0;     ///< of the mailbox, at the last put()
  std::size_t undelivered_ = 0;  ///< packets put since the mailbox was emptied last, by then
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
  std::int64_t last_reading_ = 0;  ///< of the grid, by number
  bool key_wanted_ = false;
  bool settled_ = false;  ///< what the last packet begun shows stays, until something changes
  bool refined_ = false;  ///< and it is as good as was asked for
  bool busy_ = false;     ///< the content takes no other packet yet
  bool scheduled_ = false;
  bool unhurried_ = false;  ///< what it is scheduled for is no change, and gives way to one
};

}  // namespace tweend::streams
