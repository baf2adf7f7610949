#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/post.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/streams/producer.hpp"
#include "tests/streams/streaming.hpp"

// Which packets decode on their own where packets need the ones before them, and what comes half a second after something has
// come to rest on a lower rung. The content is made up, so that nothing but the producer is looked at.

namespace tweend::streams {
namespace {

using protocol::kFlagDiscontinuity;
using protocol::kFlagKey;
using protocol::kFlagLast;
using test::RecordingSink;
using test::RunningStage;
using test::scene_of;
using test::square_actor;

constexpr ClockUs kSecond_us = 1'000'000;

/// What the made-up content shows. Safe from any thread.
struct Shown {
  std::atomic<bool> moving{true};
  std::atomic<std::uint64_t> continuity{0};
  std::atomic<bool> chained{true};
};

/// Makes packets of nothing, at once, each needing the one before; the payload says whether it was refined.
class MadeUp final : public Content {
 public:
  MadeUp(Shown& shown, boost::asio::io_context& strand, ContentOwner& owner) : shown_(shown), strand_(strand), owner_(owner) {}

  bool follow(const stage::SceneViewPtr&) override { return true; }
  bool shows_the_same(const stage::SceneView&) const noexcept override { return false; }
  ClockUs earliest_us() const noexcept override { return 0; }
  ContentReading read(ClockUs) override { return {0.0, shown_.moving, shown_.continuity}; }
  bool chained() const noexcept override { return shown_.chained; }
  void refine(bool refined) override { refined_ = refined; }
  void begin(NewPacketPtr packet, ClockUs) override {
    packet->payload.resize(1)[0] = std::byte{refined_};
    boost::asio::post(strand_, [this, packet = std::move(packet)]() mutable {
      owner_.ready();
      owner_.made(std::move(packet));
    });
  }
  std::string what_is_gone() const override { return "nothing"; }

 private:
  Shown& shown_;
  boost::asio::io_context& strand_;
  ContentOwner& owner_;
  bool refined_ = false;
};

class Keys : public testing::Test {
 protected:
  void SetUp() override {
    stage_.start([this](const std::string&, const stage::SceneViewPtr& view) {
      if (producer_) {
        EXPECT_TRUE(producer_->follow(view));
      }
    });
  }
  void TearDown() override {
    stage_->post([this] { producer_->stop(); });
    stage_.settle();
    stage_.stop();
    delivery_.stop();
  }

  void make(StreamKey key) {
    const auto made = [this] {
      if (ask_with_each_) producer_->request_key();
    };
    const Producer::Environment environment{stage_->strand(), mailbox_, stage_.metrics, made, [] {}};
    const auto make_content = [this](ContentOwner& owner) { return std::make_shared<MadeUp>(shown_, stage_->strand(), owner); };
    stage_->post([this, key = std::move(key), environment, make_content] {
      producer_ = std::make_shared<Producer>(key, 1, environment, make_content);
      EXPECT_TRUE(producer_->follow(stage_.view()));
      producer_->add({sink_, 1});
    });
  }
  void make(double rate) { make(test::vertices_of("main", "square", rate)); }
  void join(std::uint32_t stream) {
    stage_->post([this, stream] { producer_->add({sink_, stream}); });
  }
  void change_something() {
    static_cast<void>(stage_.edit({"main", "test.edit", {}, {}},
                                  RunningStage::applies(stage::SetSceneSettings{test::with_ambient(next_ambient_ += 0.01F)})));
  }
  static bool is(const PacketPtr& packet, std::uint8_t flag) { return (packet->header.flags & flag) != 0; }

  Shown shown_;
  RunningStage stage_{{scene_of("main", {square_actor("square")})}};
  WorkerPool delivery_{1};
  Mailbox mailbox_{[this](Task task) { delivery_.post(std::move(task)); }, stage_.metrics};
  std::shared_ptr<RecordingSink> sink_ = std::make_shared<RecordingSink>();
  std::shared_ptr<Producer> producer_;
  float next_ambient_ = 0.1F;
  bool ask_with_each_ = false;  ///< for a key, with each packet; set before make()
};

TEST_F(Keys, ComeFirstAndOnceASecond) {
  constexpr ClockUs kPeriodUs = 20'000;
  make(50.0);
  const auto packets = sink_->wait_for(1, 120);
  ASSERT_TRUE(is(packets[0], kFlagKey));
  ClockUs last_us = packets[0]->header.server_us;
  std::size_t keys = 1;
  for (std::size_t i = 1; i < packets.size(); ++i) {
    const ClockUs at_us = packets[i]->header.server_us;
    if (is(packets[i], kFlagKey)) {
      EXPECT_GT(at_us - last_us, kSecond_us - kPeriodUs) << "the next one would be too late";
      last_us = at_us;
      ++keys;
    } else {
      EXPECT_LE(at_us - last_us, kSecond_us);
    }
  }
  EXPECT_GE(keys, 3U);
}

TEST_F(Keys, AreAllOfSlowStreams) {
  make(1.0);
  for (const PacketPtr& packet : sink_->wait_for(1, 2)) EXPECT_TRUE(is(packet, kFlagKey));
}

TEST_F(Keys, AreAllWherePacketsNeedNoOthers) {
  shown_.chained = false;
  make(100.0);
  for (const PacketPtr& packet : sink_->wait_for(1, 20)) EXPECT_TRUE(is(packet, kFlagKey));
}

TEST_F(Keys, AreJumpsAndEdits) {
  make(100.0);
  sink_->wait_for(1, 5);
  shown_.continuity = 1;
  const auto jumped = sink_->wait_until(1, [](const Packet& p) { return (p.header.flags & kFlagDiscontinuity) != 0; });
  EXPECT_TRUE(is(jumped.back(), kFlagKey));
  change_something();
  const std::uint64_t revision = stage_.revision();
  const auto edited = sink_->wait_until(1, [&](const Packet& p) { return p.header.revision == revision; });
  EXPECT_TRUE(is(edited.back(), kFlagKey));
}

TEST_F(Keys, AreFinalStates) {
  make(100.0);
  sink_->wait_for(1, 5);
  shown_.moving = false;
  const auto packets = sink_->wait_until(1, [](const Packet& p) { return (p.header.flags & kFlagLast) != 0; });
  EXPECT_TRUE(is(packets.back(), kFlagKey));
  // Whoever joins now is given that one, and nobody anything else.
  join(2);
  EXPECT_EQ(sink_->wait_for(2, 1)[0], packets.back());
}

TEST_F(Keys, ComeSoonForWhoJoins) {
  make(100.0);
  sink_->wait_until(1, [](const Packet& p) { return (p.header.flags & kFlagKey) == 0; });
  join(2);
  const auto joined = sink_->wait_until(2, [](const Packet& p) { return (p.header.flags & kFlagKey) != 0; });
  ClockUs last_key_us = 0;  // before that one
  for (const PacketPtr& packet : sink_->packets(1)) {
    if (packet == joined.back()) break;
    if (is(packet, kFlagKey)) last_key_us = packet->header.server_us;
  }
  // The first one may have been in the making when the wish came.
  for (std::size_t i = 1; i + 1 < joined.size(); ++i) {
    EXPECT_LT(joined[i]->header.server_us - last_key_us, 250'000)
        << "a quarter of a second is enough, not the second's own key";
  }
}

TEST_F(Keys, ThatAreAskedForAreAQuarterOfASecondApart) {
  ask_with_each_ = true;
  make(200.0);
  std::vector<ClockUs> keys_us;
  for (const PacketPtr& packet : sink_->wait_for(1, 200)) {
    const ClockUs at_us = packet->header.server_us;
    if (is(packet, kFlagKey)) {
      keys_us.push_back(at_us);
    } else {
      ASSERT_FALSE(keys_us.empty());
      EXPECT_LT(at_us - keys_us.back(), 250'000) << "and no further";
    }
  }
  ASSERT_GE(keys_us.size(), 3U);
  for (std::size_t i = 1; i < keys_us.size(); ++i) EXPECT_GE(keys_us[i] - keys_us[i - 1], 250'000);
}

TEST_F(Keys, AreMadeAgainOfWhatStandsStillForWhoAsks) {
  shown_.moving = false;
  make(100.0);
  const PacketPtr first = sink_->wait_for(1, 1)[0];
  stage_->post([this] { producer_->request_key(); });
  const PacketPtr again = sink_->wait_for(1, 2)[1];
  EXPECT_TRUE(is(again, kFlagKey));
  EXPECT_TRUE(is(again, kFlagLast));
  EXPECT_EQ(again->header.sequence, first->header.sequence + 1);
  EXPECT_GE(again->header.server_us - first->header.server_us, 250'000);
}

StreamKey on_rung(std::size_t rung) {
  FramesSpec frames;
  frames.size = {64, 48};
  frames.rung = rung;
  return {"main", 100.0, frames};
}

bool refined(const Packet& packet) { return packet.payload.bytes()[0] == std::byte{1}; }

TEST_F(Keys, OnALowerRungWhatComesToRestIsMadeAsGoodAsWasAskedForHalfASecondLater) {
  shown_.chained = false;
  make(on_rung(2));
  sink_->wait_for(1, 5);
  shown_.moving = false;
  const auto packets = sink_->wait_until(1, [](const Packet& p) { return (p.header.flags & kFlagLast) != 0; });
  const PacketPtr& best = packets.back();
  const PacketPtr& rest = packets[packets.size() - 2];
  EXPECT_TRUE(refined(*best));
  EXPECT_GE(best->header.server_us - rest->header.server_us, 500'000);
  for (std::size_t i = 0; i + 1 < packets.size(); ++i) {
    EXPECT_FALSE(refined(*packets[i])) << i;
    EXPECT_FALSE(is(packets[i], kFlagLast)) << "a better one follows";
  }
  // A change is shown as the rung has it again.
  change_something();
  EXPECT_FALSE(refined(*sink_->wait_for(1, packets.size() + 1)[packets.size()]));
}

TEST_F(Keys, OnALowerRungAChangeWhileAllStandsStillIsShownAsTheRungHasItAndThenBetter) {
  shown_.chained = false;
  shown_.moving = false;
  make(on_rung(1));
  EXPECT_FALSE(refined(*sink_->wait_for(1, 1)[0]));
  change_something();
  const std::uint64_t revision = stage_.revision();
  const auto of_it = [&](bool better) {
    return [=](const Packet& p) { return p.header.revision == revision && refined(p) == better; };
  };
  const PacketPtr plain = sink_->wait_until(1, of_it(false)).back();
  const PacketPtr better = sink_->wait_until(1, of_it(true)).back();
  EXPECT_EQ(better->header.sequence, plain->header.sequence + 1);
  EXPECT_GE(better->header.server_us - plain->header.server_us, 500'000);
}

TEST_F(Keys, TheTopRungIsAsGoodAsWasAskedForFromTheStart) {
  shown_.chained = false;
  shown_.moving = false;
  make(on_rung(0));
  const PacketPtr first = sink_->wait_for(1, 1)[0];
  EXPECT_TRUE(refined(*first));
  EXPECT_TRUE(is(first, kFlagLast));
}

TEST_F(Keys, DelaysAreMeasured) {
  make(100.0);
  sink_->wait_for(1, 10);
  EXPECT_GE(stage_.metrics.packet_delay_seconds.read().count, 10);
  EXPECT_GE(stage_.metrics.packet_jitter_seconds.read().count, 9);
}

}  // namespace
}  // namespace tweend::streams
