#include <gtest/gtest.h>

#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/streams/frame_content.hpp"
#include "tests/streams/picturing.hpp"

// The steps in which a picture is made, seen by the content's owner; and streams of pictures that are broken off.

namespace tweend::streams {
namespace {

using test::frames_of;
using test::kSmall;
using test::scene_of;
using test::square_actor;
using test::Streaming;

std::vector<model::ScenePtr> one_scene() { return {scene_of("main", {square_actor("square")})}; }

/// A content's owner that begins a picture whenever it may, and remembers what it was told in which order.
class Owner final : public ContentOwner {
 public:
  Owner(Streaming& s, const StreamKey& key, std::size_t pictures)
      : s_(s),
        left_(pictures),
        content_(std::make_shared<FrameContent>(std::get<FramesSpec>(key.what), key.rate, s.stage->strand(), s.workers, desk_,
                                                *this)) {}

  /// @return once all pictures are made, the owner's diary: "b" begun, "r" ready for another, "m" made, "e" an error
  std::string run() {
    s_.stage->post([this] {
      followed_ = content_->follow(s_.stage.view());
      begin();
    });
    auto done = done_.get_future();
    EXPECT_EQ(done.wait_for(test::kPatience), std::future_status::ready);
    return diary_;
  }
  [[nodiscard]] bool followed() const noexcept { return followed_; }
  [[nodiscard]] const std::vector<std::uint32_t>& made_sequences() const noexcept { return sequences_; }
  [[nodiscard]] const std::string& reason() const noexcept { return reason_; }

  void ready() override {
    diary_ += 'r';
    if (left_ > 0) begin();
  }
  void made(Result<NewPacketPtr> packet) override {
    diary_ += packet ? 'm' : 'e';
    if (packet) {
      sequences_.push_back((*packet)->header.sequence);
    } else {
      reason_ = packet.error().message;
    }
    if (--in_making_ > 0 || left_ > 0) return;
    // Not here: the content is still at work in this call.
    s_.stage->post([this] { done_.set_value(); });
  }

 private:
  void begin() {
    diary_ += 'b';
    --left_;
    ++in_making_;
    static_cast<void>(content_->read(steady_now_us()));
    NewPacketPtr packet = pool_->take();
    packet->header.sequence = next_++;
    content_->begin(std::move(packet), steady_now_us());
  }

  Streaming& s_;
  PictureDesk desk_{s_.stage->strand(), s_.workers, s_.renderer};
  std::size_t left_;
  std::size_t in_making_ = 0;
  std::uint32_t next_ = 0;
  bool followed_ = false;
  std::string diary_, reason_;
  std::vector<std::uint32_t> sequences_;
  std::promise<void> done_;
  std::shared_ptr<PacketPool> pool_ = std::make_shared<PacketPool>();
  std::shared_ptr<FrameContent> content_;
};

TEST(FrameSteps, RefuseEveryPictureWhereNothingDraws) {
  Streaming s(one_scene());
  Owner owner(s, frames_of("main"), 3);
  EXPECT_EQ(owner.run(), "brberbere") << "ready for another, which is refused in its turn";
  EXPECT_NE(owner.reason().find("--no-render"), std::string::npos) << owner.reason();
}

TEST(FrameSteps, BeginTheNextPictureWhileTheOneBeforeIsBeingEncoded) {
  Streaming s(one_scene(), 2, render::RenderOptions{});
  if (!s.renderer.device()) GTEST_SKIP() << s.renderer.device().error().message;
  Owner owner(s, frames_of("main", FrameEncoding::Png), 6);
  const std::string diary = owner.run();
  EXPECT_TRUE(owner.followed());
  EXPECT_EQ(diary.substr(0, 3), "brb") << "the second is begun before the first is made: " << diary;
  std::size_t begun = 0, ready = 0, made = 0;
  for (const char step : diary) {
    begun += step == 'b' ? 1U : 0U;
    ready += step == 'r' ? 1U : 0U;
    made += step == 'm' ? 1U : 0U;
    EXPECT_LE(made, ready) << "made only after its last leg: " << diary;
    EXPECT_LE(begun - made, 2U) << "one picture in each step: " << diary;
  }
  EXPECT_EQ(made, 6U);
  EXPECT_EQ(owner.made_sequences(), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
}

TEST(FrameSteps, EndAStreamWithItsReasonWhereNothingDraws) {
  Streaming s(one_scene());
  const StreamKey key = frames_of("main");
  s.subscribe(key, 1);
  const std::string reason = s.sink->wait_for_end(1);
  EXPECT_NE(reason.find("--no-render"), std::string::npos) << reason;
  s.settle();
  EXPECT_EQ(s.stage.metrics.producers.load(), 0) << "nobody looks at one that has ended";
  s.subscribe(key, 2);
  EXPECT_EQ(s.sink->wait_for_end(2), reason);
  EXPECT_TRUE(s.sink->packets(1).empty());
}

TEST(FrameSteps, KeepNobodyWaitingForADeliveryThatNeverComes) {
  Streaming s(one_scene());
  s.subscribe(frames_of("main"), 1);
  const auto told = std::make_shared<std::promise<void>>();
  s.stage->post([&s, told] { s.hub.after_delivery(s.stage.view(), [told] { told->set_value(); }); });
  ASSERT_EQ(told->get_future().wait_for(test::kPatience), std::future_status::ready);
}

TEST(FrameSteps, LeaveNothingBehindWhenStreamsAreBrokenOff) {
  for (int i = 0; i < 20; ++i) {
    Streaming s(one_scene(), 2, render::RenderOptions{.off = i % 4 == 3});
    s.stage.act([](stage::Player& player, const stage::PlayRange& range, ClockUs now_us) { player.play(range, now_us); });
    s.subscribe(frames_of("main", FrameEncoding::Png), 1);
    s.subscribe(frames_of("main", FrameEncoding::Jpeg), 2);
    s.subscribe(frames_of("main", FrameEncoding::Rgba), 3);
    // At each stage of the making: none begun, the first under way, some delivered.
    if (i % 4 == 1) s.stage.settle();
    if (i % 4 == 2) s.sink->wait_for(1, 2);
  }
}

TEST(FrameSteps, SurviveViewersWhoComeAndGo) {
  Streaming s(one_scene(), 2, render::RenderOptions{});
  if (!s.renderer.device()) GTEST_SKIP() << s.renderer.device().error().message;
  s.stage.act([](stage::Player& player, const stage::PlayRange& range, ClockUs now_us) { player.play(range, now_us); });
  for (std::uint32_t i = 0; i < 20; ++i) {
    const StreamKey key = frames_of("main", i % 2 == 0 ? FrameEncoding::Jpeg : FrameEncoding::Rgba);
    s.subscribe(key, i);
    if (i % 3 != 0) s.sink->wait_for(i, 1);
    s.unsubscribe(key, i);
  }
  s.settle();
  EXPECT_EQ(s.stage.metrics.producers.load(), 0);
  s.subscribe(frames_of("main"), 100);
  EXPECT_EQ(s.sink->wait_for(100, 1)[0]->header.sequence, 0U);
}

}  // namespace
}  // namespace tweend::streams
