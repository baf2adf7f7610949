#include "server/streams/frame_content.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/streams/picturing.hpp"

namespace tweend::streams {
namespace {

using protocol::kFlagDiscontinuity;
using protocol::kFlagKey;
using protocol::kFlagLast;
using stage::Player;
using stage::PlayRange;
using test::Decoded;
using test::frames_of;
using test::from_above;
using test::kSmall;
using test::RecordingSink;
using test::RunningStage;
using test::scene_of;
using test::square_actor;
using test::Streaming;

constexpr std::size_t kScenes = 40;

RunningStage::Act play() {
  return [](Player& player, const PlayRange& range, ClockUs now_us) { player.play(range, now_us); };
}
RunningStage::Act seek_to(double time_s) {
  return [time_s](Player& player, const PlayRange& range, ClockUs now_us) { player.seek(range, time_s, now_us); };
}

/// Streams of pictures on one stage and one context, which takes its time to open. Each test has a scene of its own.
class Frames : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::vector<model::ScenePtr> scenes;
    for (std::size_t i = 0; i < kScenes; ++i) {
      scenes.push_back(scene_of("s" + std::to_string(i), {square_actor("square"), square_actor("other")}));
    }
    streaming_ = std::make_unique<Streaming>(std::move(scenes), 2, render::RenderOptions{});
  }
  static void TearDownTestSuite() { streaming_.reset(); }
  void SetUp() override {
    scene_ = "s" + std::to_string(next_scene_++);
    ASSERT_LE(next_scene_, kScenes);
    if (!s_.renderer.device()) GTEST_SKIP() << s_.renderer.device().error().message;
  }

  Streaming& s_ = *streaming_;
  std::string scene_;
  /// A sink for each test: what another test's streams sent is not in it.
  std::shared_ptr<RecordingSink> sink_ = std::make_shared<RecordingSink>();

  void TearDown() override {
    for (const auto& [key, stream] : opened_) {
      s_.stage->post([this, key, stream] { s_.hub.unsubscribe(key, sink_.get(), stream); });
    }
    s_.settle();
    EXPECT_EQ(s_.stage.metrics.producers.load(), 0);
  }

  void subscribe(const StreamKey& key, std::uint32_t stream) {
    opened_.emplace_back(key, stream);
    s_.subscribe(key, sink_, stream);
  }
  void retune(const StreamKey& from, const StreamKey& to, std::uint32_t stream) {
    opened_.emplace_back(to, stream);
    s_.stage->post([this, from, to, stream] { s_.hub.retune(from, to, {sink_, stream}); });
  }
  RunningStage::Answer edit(stage::Change change) {
    return s_.stage.edit({scene_, "test.edit", {}, {}}, RunningStage::applies(std::move(change)));
  }
  void act(RunningStage::Act act) { s_.stage.act(std::move(act), {}, scene_); }
  [[nodiscard]] Decoded now(const StreamKey& key) { return test::picture_of(s_, key, s_.stage.view(scene_)); }
  void settle() { s_.settle(); }
  /// The first packet from the i-th on that shows exactly this.
  PacketPtr wait_for_picture(std::uint32_t stream, const Decoded& picture) {
    return sink_
        ->wait_until(stream, [&](const Packet& p) { return test::mean_difference(test::decoded(p, kSmall), picture) == 0.0; })
        .back();
  }

 private:
  static inline std::unique_ptr<Streaming> streaming_;
  static inline std::size_t next_scene_ = 0;
  std::vector<std::pair<StreamKey, std::uint32_t>> opened_;
};

TEST_F(Frames, AreRefusedWhereTheSceneOrTheActorIsNotThere) {
  subscribe(frames_of("nowhere"), 1);
  EXPECT_EQ(sink_->wait_for_end(1), "the scene \"nowhere\" was removed");
  StreamKey key = frames_of(scene_);
  std::get<FramesSpec>(key.what).actor = "nobody";
  subscribe(key, 2);
  EXPECT_EQ(sink_->wait_for_end(2), "the actor \"nobody\" of the scene \"" + scene_ + "\" was removed");
}

TEST_F(Frames, EndWhereThePictureIsTooLargeForTheDevice) {
  StreamKey key = frames_of(scene_);
  std::get<FramesSpec>(key.what).size = {100'000, 10};
  subscribe(key, 1);
  EXPECT_NE(sink_->wait_for_end(1).find("found 100000 x 10"), std::string::npos);
  subscribe(key, 2);
  EXPECT_NE(sink_->wait_for_end(2).find("found 100000 x 10"), std::string::npos) << "who comes later hears it as well";
}

TEST_F(Frames, BeginWithAPictureAtOnce) {
  const ClockUs before_us = steady_now_us();
  subscribe(frames_of(scene_, FrameEncoding::Rgba, 0.01), 1);
  const PacketPtr packet = sink_->wait_for(1, 1)[0];
  EXPECT_EQ(packet->header.kind, protocol::PacketKind::Frame);
  EXPECT_EQ(packet->header.encoding, protocol::kFrameRgba);
  EXPECT_EQ(packet->header.flags, kFlagKey | kFlagLast);
  EXPECT_EQ(packet->header.sequence, 0U);
  EXPECT_EQ(packet->header.media_us, 0);
  EXPECT_EQ(packet->header.payload_bytes, 4 * kSmall.width * kSmall.height);
  EXPECT_GE(packet->header.server_us, before_us);
  EXPECT_LT(packet->header.server_us, before_us + 50'000'000) << "and not a reading of the grid later";
}

TEST_F(Frames, ShowTheSameInEveryEncoding) {
  act(seek_to(1.25));
  const Decoded want = now(frames_of(scene_));
  EXPECT_GT(test::covered(want), 50U) << "there is something to be seen";
  std::uint32_t stream = 0;
  for (const auto& [encoding, number, tolerance] :
       {std::tuple(FrameEncoding::Rgba, protocol::kFrameRgba, 0.0), std::tuple(FrameEncoding::Png, protocol::kFramePng, 0.0),
        std::tuple(FrameEncoding::Jpeg, protocol::kFrameJpeg, 2.0)}) {
    subscribe(frames_of(scene_, encoding), ++stream);
    const PacketPtr packet = sink_->wait_for(stream, 1)[0];
    EXPECT_EQ(packet->header.encoding, number);
    EXPECT_EQ(packet->header.payload_bytes, packet->payload.bytes().size());
    EXPECT_LE(test::mean_difference(test::decoded(*packet, kSmall), want), tolerance);
    EXPECT_EQ(packet->header.media_us, 1'250'000);
  }
}

// Packets that wait are counted by their lengths: what a compressed picture might have taken is no room of its packet.
TEST_F(Frames, TakeTheMemoryOfTheirBytesAlone) {
  std::uint32_t stream = 1;
  for (const FrameEncoding encoding : {FrameEncoding::Jpeg, FrameEncoding::Png, FrameEncoding::H264}) {
    subscribe(frames_of(scene_, encoding), stream);
    const PacketPtr packet = sink_->wait_for(stream++, 1)[0];
    EXPECT_GT(packet->header.payload_bytes, 0U);
    EXPECT_EQ(packet->payload.capacity(), packet->header.payload_bytes);
  }
}

TEST_F(Frames, CarryTheMediaTimeOfTheActorThatIsNamed) {
  s_.stage.act(seek_to(1.5), "other", scene_);
  StreamKey key = frames_of(scene_);
  subscribe(key, 1);
  EXPECT_EQ(sink_->wait_for(1, 1)[0]->header.media_us, 0) << "the first actor's where none is named";
  std::get<FramesSpec>(key.what).actor = "other";
  subscribe(key, 2);
  EXPECT_EQ(sink_->wait_for(2, 1)[0]->header.media_us, 1'500'000);
}

TEST_F(Frames, ComeOnceForEachChangeWhileNothingMoves) {
  const StreamKey key = frames_of(scene_);
  subscribe(key, 1);
  sink_->wait_for(1, 1);
  for (std::size_t i = 1; i <= 5; ++i) {
    ASSERT_TRUE(edit(stage::SetSceneSettings{test::with_ambient(0.1F * static_cast<float>(i))}));
    sink_->wait_for(1, i + 1);
    settle();
    const std::vector<PacketPtr> packets = sink_->packets(1);
    ASSERT_EQ(packets.size(), i + 1) << "exactly one packet a change";
    EXPECT_EQ(packets.back()->header.sequence, i);
    EXPECT_NE(packets.back()->header.flags & kFlagLast, 0);
    EXPECT_EQ(test::mean_difference(test::decoded(*packets.back(), kSmall), now(key)), 0.0);
  }
}

TEST_F(Frames, StayAwayWhereAnEditShowsNothingElse) {
  subscribe(frames_of(scene_), 1);
  sink_->wait_for(1, 1);
  s_.stage.change_players(
      scene_, [](const stage::PlayersTurn&) -> Result<std::vector<std::size_t>> { return std::vector<std::size_t>{}; });
  s_.let_pass(test::vertices_of(scene_, "square", 100.0), 1);
  EXPECT_EQ(sink_->packets(1).size(), 1U);
}

TEST_F(Frames, ComeOnTheGridOneAfterAnotherWhileSomethingMoves) {
  constexpr ClockUs kPeriodUs = 50'000;
  constexpr std::uint32_t kPackets = 8;
  act(play());
  const auto missed = [this] { return s_.stage.metrics.ticks_missed_total.load(); };
  const std::int64_t missed_before = missed();
  subscribe(frames_of(scene_, FrameEncoding::Jpeg, 1e6 / static_cast<double>(kPeriodUs)), 1);
  const std::vector<PacketPtr> packets = sink_->wait_for(1, kPackets);
  const stage::SceneViewPtr view = s_.stage.view(scene_);
  std::int64_t off_grid = 0;
  for (std::uint32_t i = 0; i < kPackets; ++i) {
    const protocol::PacketHeader& header = packets[i]->header;
    EXPECT_EQ(header.sequence, i);
    EXPECT_EQ(packets[i]->source, packets[0]->source);
    EXPECT_EQ(header.flags & kFlagLast, 0);
    const stage::Show show = stage::show_at(*view, header.server_us);
    EXPECT_EQ(header.media_us, std::llround(show.actors.front().time_s * 1e6));
    if (i == 0) continue;  // it is made at once, off the grid
    EXPECT_GT(header.server_us, packets[i - 1]->header.server_us);
    off_grid += header.server_us % kPeriodUs == 0 ? 0 : 1;
  }
  // A machine that is away for a whole period goes on with what is shown then, and has missed a reading.
  EXPECT_LE(off_grid, missed() - missed_before);
}

TEST_F(Frames, ShowWhatIsShownAtTheReadingTheyTellOf) {
  act(play());
  const StreamKey key = frames_of(scene_);
  subscribe(key, 1);
  const std::vector<PacketPtr> packets = sink_->wait_for(1, 4);
  for (const PacketPtr& packet : packets) {
    const Decoded want = test::picture_of(s_, key, s_.stage.view(scene_), packet->header.server_us);
    EXPECT_EQ(test::mean_difference(test::decoded(*packet, kSmall), want), 0.0);
  }
}

TEST_F(Frames, AreMadeOnceForAllWhoWantTheSame) {
  subscribe(frames_of(scene_), 1);
  subscribe(frames_of(scene_), 2);
  const PacketPtr packet = sink_->wait_for(1, 1)[0];
  EXPECT_EQ(sink_->wait_for(2, 1)[0], packet);
  EXPECT_EQ(s_.stage.metrics.producers.load(), 1);
  act(seek_to(2.0));
  EXPECT_EQ(sink_->wait_for(1, 2)[1], sink_->wait_for(2, 2)[1]) << "the same buffer, not a copy";
  subscribe(frames_of(scene_), 3);
  EXPECT_EQ(sink_->wait_for(3, 1)[0], sink_->wait_for(1, 2)[1]) << "who comes late is given the latest there is";
  settle();
  EXPECT_EQ(sink_->packets(1).size(), 2U);
}

TEST_F(Frames, AreMadeTwiceForTwoCamerasSizesQualitiesOrEncodings) {
  std::vector<StreamKey> keys(4, frames_of(scene_, FrameEncoding::Jpeg));
  keys[1] = test::seen_by(keys[1], from_above(9.0F));
  std::get<FramesSpec>(keys[2].what).quality = 10;
  std::get<FramesSpec>(keys[3].what).size = {32, 32};
  for (std::uint32_t i = 0; i < keys.size(); ++i) subscribe(keys[i], i);
  std::vector<std::uint64_t> sources;
  for (std::uint32_t i = 0; i < keys.size(); ++i) sources.push_back(sink_->wait_for(i, 1)[0]->source);
  std::sort(sources.begin(), sources.end());
  EXPECT_EQ(std::unique(sources.begin(), sources.end()), sources.end());
  const auto bytes = [&](std::uint32_t i) { return sink_->packets(i)[0]->payload.bytes().size(); };
  EXPECT_LT(bytes(2), bytes(0)) << "a lower quality takes less";
  EXPECT_EQ(test::decode_jpeg(sink_->packets(3)[0]->payload.bytes()).size, (render::Size{32, 32}));
}

TEST_F(Frames, OfTheOnlyViewerGoOnFromAnotherCamera) {
  const StreamKey from = frames_of(scene_);
  const StreamKey to = test::seen_by(from, from_above(5.0F));
  subscribe(from, 1);
  const PacketPtr first = sink_->wait_for(1, 1)[0];
  retune(from, to, 1);
  const PacketPtr second = sink_->wait_for(1, 2)[1];
  EXPECT_EQ(second->source, first->source);
  EXPECT_EQ(second->header.sequence, 1U);
  EXPECT_NE(second->header.flags & kFlagLast, 0);
  EXPECT_EQ(test::mean_difference(test::decoded(*second, kSmall), now(to)), 0.0);
  EXPECT_GT(test::mean_difference(test::decoded(*first, kSmall), now(to)), 0.1);
}

TEST_F(Frames, OfOneOfTwoViewersLeaveTheOtherAsHeLooks) {
  const StreamKey from = frames_of(scene_);
  const StreamKey to = test::seen_by(from, from_above(5.0F));
  subscribe(from, 1);
  subscribe(from, 2);
  const PacketPtr first = sink_->wait_for(1, 1)[0];
  retune(from, to, 1);
  const PacketPtr second = sink_->wait_for(1, 2)[1];
  EXPECT_NE(second->source, first->source);
  EXPECT_EQ(second->header.sequence, 0U);
  EXPECT_EQ(test::mean_difference(test::decoded(*second, kSmall), now(to)), 0.0);
  settle();
  EXPECT_EQ(sink_->packets(2).size(), 1U);
  EXPECT_EQ(s_.stage.metrics.producers.load(), 2);
}

TEST_F(Frames, OfAViewerWhoComesToLookAsAnotherDoesAreShared) {
  const StreamKey from = frames_of(scene_);
  const StreamKey to = test::seen_by(from, from_above(5.0F));
  subscribe(from, 1);
  subscribe(to, 2);
  sink_->wait_for(1, 1);
  const PacketPtr shared = sink_->wait_for(2, 1)[0];
  retune(from, to, 1);
  EXPECT_EQ(sink_->wait_for(1, 2)[1], shared);
  settle();
  EXPECT_EQ(s_.stage.metrics.producers.load(), 1);
}

TEST_F(Frames, OfADraggedCameraEndWithWhereItWasLetGo) {
  StreamKey from = frames_of(scene_);
  subscribe(from, 1);
  sink_->wait_for(1, 1);
  std::promise<void> dragged;  // the strand waits for it: all come together
  s_.stage->post([end = dragged.get_future().share()] { end.wait(); });
  for (int i = 1; i <= 50; ++i) {
    const StreamKey to = test::seen_by(from, from_above(8.0F - 0.05F * static_cast<float>(i)));
    retune(from, to, 1);
    from = to;
  }
  dragged.set_value();
  const PacketPtr last = wait_for_picture(1, now(from));
  EXPECT_NE(last->header.flags & kFlagLast, 0);
  s_.let_pass(frames_of(scene_, FrameEncoding::Jpeg), 1);
  const std::vector<PacketPtr> packets = sink_->packets(1);
  EXPECT_EQ(packets.back(), last) << "nothing follows";
  EXPECT_LT(packets.size(), 51U) << "those that nobody could have seen are left out";
  for (std::size_t i = 0; i < packets.size(); ++i) {
    EXPECT_EQ(packets[i]->header.sequence, i);
    EXPECT_EQ(packets[i]->source, packets[0]->source);
  }
}

TEST_F(Frames, GoOnAtAnotherRate) {
  act(play());
  const StreamKey slow = frames_of(scene_, FrameEncoding::Jpeg, 0.01);
  const StreamKey fast = frames_of(scene_, FrameEncoding::Jpeg, 100.0);
  subscribe(slow, 1);
  const PacketPtr first = sink_->wait_for(1, 1)[0];
  retune(slow, fast, 1);
  const std::vector<PacketPtr> packets = sink_->wait_for(1, 5);
  EXPECT_EQ(packets[4]->source, first->source);
}

TEST_F(Frames, EndWithTheActorTheyName) {
  StreamKey key = frames_of(scene_);
  subscribe(key, 1);
  std::get<FramesSpec>(key.what).actor = "other";
  subscribe(key, 2);
  sink_->wait_for(1, 1);
  sink_->wait_for(2, 1);
  ASSERT_TRUE(edit(stage::SetActor{"other", nullptr}));
  EXPECT_EQ(sink_->wait_for_end(2), "the actor \"other\" of the scene \"" + scene_ + "\" was removed");
  sink_->wait_for(1, 2);
  ASSERT_TRUE(edit(stage::SetActor{"square", nullptr}));
  const PacketPtr empty = sink_->wait_for(1, 3)[2];
  EXPECT_EQ(test::covered(test::decoded(*empty, kSmall)), 0U) << "of a scene without actors there is a picture still";
  EXPECT_EQ(empty->header.media_us, 0);
  EXPECT_EQ(sink_->ends(), 1U);
}

TEST_F(Frames, EndWithTheirScene) {
  subscribe(frames_of(scene_), 1);
  sink_->wait_for(1, 1);
  ASSERT_TRUE(RunningStage::wait(s_.stage.remove_later({scene_, "scene.remove", {}, {}})));
  EXPECT_EQ(sink_->wait_for_end(1), "the scene \"" + scene_ + "\" was removed");
}

TEST_F(Frames, TellOfEditsAndSeeksAsOfJumps) {
  subscribe(frames_of(scene_), 1);
  EXPECT_EQ(sink_->wait_for(1, 1)[0]->header.flags & kFlagDiscontinuity, 0);
  act(seek_to(1.0));
  EXPECT_NE(sink_->wait_for(1, 2)[1]->header.flags & kFlagDiscontinuity, 0);
  ASSERT_TRUE(edit(stage::SetSceneSettings{test::with_grid(true)}));
  const PacketPtr packet = sink_->wait_for(1, 3)[2];
  EXPECT_NE(packet->header.flags & kFlagDiscontinuity, 0);
  EXPECT_EQ(packet->header.revision, s_.stage.revision(scene_));
}

TEST_F(Frames, AreFollowedByWhoWaitsForTheirDelivery) {
  subscribe(frames_of(scene_), 1);
  sink_->wait_for(1, 1);
  act(seek_to(2.0));
  std::promise<std::size_t> packets;
  s_.stage->post([&] { s_.hub.after_delivery(s_.stage.view(scene_), [&] { packets.set_value(sink_->packets(1).size()); }); });
  auto future = packets.get_future();
  ASSERT_EQ(future.wait_for(test::kPatience), std::future_status::ready);
  sink_->wait_for(1, 2);
}

TEST_F(Frames, TurnWithAnActorThatSpinsThoughItsClipStandsStill) {
  model::ActorSettings settings = test::with_spin(3.0);
  auto still = std::make_shared<model::Actor>(*square_actor("square", {test::ClipParts{.keys = 1}}));
  still->settings = settings;
  ASSERT_TRUE(edit(stage::SetActor{"square", still}));
  act(play());
  subscribe(frames_of(scene_), 1);
  const std::vector<PacketPtr> packets = sink_->wait_for(1, 6);
  EXPECT_EQ(packets[5]->header.flags & kFlagLast, 0);
  EXPECT_GT(test::mean_difference(test::decoded(*packets[1], kSmall), test::decoded(*packets[5], kSmall)), 0.0);
}

}  // namespace
}  // namespace tweend::streams
