#include "server/streams/hub.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/streams/streaming.hpp"
#include "tests/support/allocations.hpp"

namespace tweend::streams {
namespace {

using stage::Loop;
using stage::Player;
using stage::PlayRange;
using test::RecordingSink;
using test::RunningStage;
using test::scene_of;
using test::square_actor;
using test::Streaming;
using ::testing::Test;

const StreamKey kSquare = test::vertices_of("main", "square", 100.0);

std::vector<model::ScenePtr> two_scenes() {
  return {scene_of("main", {square_actor("square"), square_actor("other")}), scene_of("aside", {square_actor("square")})};
}

RunningStage::Act seek_to(double time_s) {
  return [time_s](Player& player, const PlayRange& range, ClockUs now_us) { player.seek(range, time_s, now_us); };
}

std::int64_t producers(Streaming& s) {
  s.settle();
  return s.stage.metrics.producers.load();
}

TEST(StreamKey, TellsApartWhatIsNotMadeTheSameWay) {
  EXPECT_EQ(kSquare, (test::vertices_of("main", "square", 100.0)));
  EXPECT_NE(kSquare, (test::vertices_of("main", "square", 30.0)));
  EXPECT_NE(kSquare, (test::vertices_of("main", "other", 100.0)));
  EXPECT_NE(kSquare, (test::vertices_of("aside", "square", 100.0)));
}

TEST(Hub, SharesAProducerAmongEqualStreams) {
  Streaming s(two_scenes());
  const auto elsewhere = std::make_shared<RecordingSink>();
  s.subscribe(kSquare, 1);
  s.subscribe(kSquare, 2);
  s.subscribe(kSquare, elsewhere, 1);
  s.sink->wait_for(1, 1);
  s.sink->wait_for(2, 1);
  elsewhere->wait_for(1, 1);
  EXPECT_EQ(producers(s), 1);
  s.stage.act(seek_to(1.0));
  const PacketPtr packet = s.sink->wait_for(1, 2)[1];
  EXPECT_EQ(s.sink->wait_for(2, 2)[1], packet);
  EXPECT_EQ(elsewhere->wait_for(1, 2)[1], packet);
  EXPECT_EQ(s.stage.metrics.packets_produced_total.load(), 2) << "each packet is made once";
}

TEST(Hub, HasAProducerForEachSceneActorAndRate) {
  Streaming s(two_scenes());
  std::uint32_t stream = 1;
  for (const StreamKey& key : {kSquare, test::vertices_of("main", "square", 30.0), test::vertices_of("main", "other", 100.0),
                               test::vertices_of("aside", "square", 100.0)}) {
    s.subscribe(key, stream++);
  }
  std::vector<std::uint64_t> sources;
  for (std::uint32_t i = 1; i < stream; ++i) sources.push_back(s.sink->wait_for(i, 1)[0]->source);
  EXPECT_EQ(producers(s), 4);
  std::sort(sources.begin(), sources.end());
  EXPECT_EQ(std::unique(sources.begin(), sources.end()), sources.end());
}

TEST(Hub, StopsAProducerWithItsLastStream) {
  Streaming s(two_scenes());
  s.stage.act(&Player::play);
  s.subscribe(kSquare, 1);
  s.subscribe(kSquare, 2);
  s.sink->wait_for(1, 2);
  s.sink->wait_for(2, 2);
  s.unsubscribe(kSquare, 1);
  EXPECT_EQ(producers(s), 1);
  const std::size_t first = s.sink->packets(1).size();
  s.sink->wait_for(2, s.sink->packets(2).size() + 3);
  EXPECT_EQ(s.sink->packets(1).size(), first) << "who has left gets no more";
  s.unsubscribe(kSquare, 2);
  EXPECT_EQ(producers(s), 0);
  const std::size_t second = s.sink->packets(2).size();
  s.let_pass(test::vertices_of("main", "other", 240.0), 10);
  EXPECT_EQ(s.sink->packets(2).size(), second);
  EXPECT_EQ(s.sink->ends(), 0U) << "who left needs no last word";
}

TEST(Hub, StartsAnotherProducerForWhoeverComesBack) {
  Streaming s(two_scenes());
  s.subscribe(kSquare, 1);
  const PacketPtr first = s.sink->wait_for(1, 1)[0];
  s.unsubscribe(kSquare, 1);
  s.stage.act(seek_to(1.0));
  s.subscribe(kSquare, 2);
  const PacketPtr second = s.sink->wait_for(2, 1)[0];
  EXPECT_NE(second->source, first->source);
  EXPECT_EQ(second->header.sequence, 0U);
  EXPECT_EQ(second->header.media_us, 1'000'000);
  EXPECT_EQ(producers(s), 1);
}

TEST(Hub, TakesBackOnlyTheStreamThatIsNamed) {
  Streaming s(two_scenes());
  s.subscribe(kSquare, 1);
  s.sink->wait_for(1, 1);
  s.unsubscribe(kSquare, 99);
  s.unsubscribe(test::vertices_of("main", "square", 12.5), 1);
  s.unsubscribe(test::vertices_of("nowhere", "square", 100.0), 1);
  const auto stranger = std::make_shared<RecordingSink>();
  s.stage->post([&] { s.hub.unsubscribe(kSquare, stranger.get(), 1); });
  EXPECT_EQ(producers(s), 1);
  s.stage.act(seek_to(1.0));
  s.sink->wait_for(1, 2);
}

TEST(Hub, OutlivesASinkThatWentWithoutAWord) {
  Streaming s(two_scenes());
  auto gone = std::make_shared<RecordingSink>();
  const RecordingSink* address = gone.get();
  s.subscribe(kSquare, gone, 1);
  gone->wait_for(1, 1);
  s.settle();
  gone.reset();
  s.stage.act(seek_to(1.0));
  s.subscribe(kSquare, 1);
  s.sink->wait_until(1, [](const Packet& p) { return p.header.media_us == 1'000'000; });
  s.stage->post([&] { s.hub.unsubscribe(kSquare, address, 1); });
  EXPECT_EQ(producers(s), 1);
  s.unsubscribe(kSquare, 1);
  EXPECT_EQ(producers(s), 0);
}

// A crowd that is reset leaves at once, and the strand carries out every leave.
TEST(Hub, TakesNoMemoryForAReaderWhoLeaves) {
  Streaming s(two_scenes());
  constexpr std::uint32_t kReaders = 1'000;
  s.subscribe(kSquare, 0);
  s.sink->wait_for(0, 1);
  std::size_t taken = SIZE_MAX;
  s.stage->post([&] {
    for (std::uint32_t i = 1; i <= kReaders; ++i) s.hub.subscribe(kSquare, {s.sink, i});
    const std::size_t before = test::allocations();
    for (std::uint32_t i = 1; i <= kReaders; ++i) s.hub.unsubscribe(kSquare, s.sink.get(), i);
    taken = test::allocations() - before;
  });
  EXPECT_EQ(producers(s), 1);
  EXPECT_EQ(taken, 0U);
  const std::size_t packets = s.sink->packets(1).size();
  s.stage.act(seek_to(1.0));
  s.sink->wait_until(0, [](const Packet& p) { return p.header.media_us == 1'000'000; });
  EXPECT_EQ(s.sink->packets(1).size(), packets) << "who left is sent nothing more";
}

TEST(HubEnd, OfAStreamWhoseActorIsNotThere) {
  Streaming s(two_scenes());
  s.subscribe(test::vertices_of("main", "nobody", 30.0), 1);
  s.subscribe(test::vertices_of("nowhere", "square", 30.0), 2);
  EXPECT_EQ(s.sink->wait_for_end(1), "the actor \"nobody\" of the scene \"main\" was removed");
  EXPECT_NE(s.sink->wait_for_end(2), "");
  EXPECT_EQ(producers(s), 0);
}

TEST(HubEnd, OfAStreamWhoseActorIsRemoved) {
  Streaming s(two_scenes());
  s.subscribe(kSquare, 1);
  s.subscribe(kSquare, 2);
  s.subscribe(test::vertices_of("main", "other", 100.0), 3);
  for (std::uint32_t i = 1; i <= 3; ++i) s.sink->wait_for(i, 1);
  ASSERT_TRUE(s.stage.edit(stage::SetActor{"square", nullptr}));
  for (std::uint32_t i = 1; i <= 2; ++i) {
    EXPECT_EQ(s.sink->wait_for_end(i), "the actor \"square\" of the scene \"main\" was removed");
  }
  EXPECT_EQ(producers(s), 1);
  EXPECT_EQ(s.sink->ends(), 2U);
  EXPECT_EQ(s.sink->wait_for(3, 2)[1]->header.revision, 1U) << "the others go on";
}

TEST(HubEnd, OfAStreamWhoseActorBecameAnotherModel) {
  Streaming s(two_scenes());
  s.subscribe(kSquare, 1);
  s.sink->wait_for(1, 1);
  ASSERT_TRUE(s.stage.edit(stage::SetActor{"square", square_actor("square")}));
  EXPECT_NE(s.sink->wait_for_end(1), "");
  EXPECT_EQ(producers(s), 0);
  s.subscribe(kSquare, 2);
  EXPECT_EQ(s.sink->wait_for(2, 1)[0]->header.revision, 1U);
}

TEST(HubEnd, OfAStreamWhoseSceneIsRemoved) {
  Streaming s(two_scenes());
  s.subscribe(test::vertices_of("aside", "square", 100.0), 1);
  s.subscribe(kSquare, 2);
  s.sink->wait_for(1, 1);
  s.sink->wait_for(2, 1);
  ASSERT_TRUE(RunningStage::wait(s.stage.remove_later({"aside", "scene.remove", {}, {}})));
  EXPECT_EQ(s.sink->wait_for_end(1), "the scene \"aside\" was removed");
  EXPECT_EQ(producers(s), 1);
  EXPECT_EQ(s.sink->ends(), 1U);
}

TEST(HubEnd, DoesNotComeBeforeTheRemovalIsDurable) {
  Streaming s(two_scenes());
  s.subscribe(kSquare, 1);
  s.sink->wait_for(1, 1);
  s.stage.store.hold();
  auto removal =
      s.stage.edit_later({"main", "actor.remove", {}, {}}, RunningStage::applies(stage::SetActor{"square", nullptr}));
  s.stage.store.wait_for_commits(1);
  s.settle();
  EXPECT_EQ(s.sink->ends(), 0U);
  s.stage.store.fail_next(1);
  s.stage.store.release();
  EXPECT_FALSE(RunningStage::wait(std::move(removal)));
  s.stage.act(seek_to(1.0));
  s.sink->wait_for(1, 2);
  EXPECT_EQ(s.sink->ends(), 0U);
}

TEST(HubEnd, ActorsMayChangePlacesUnderAStream) {
  Streaming s(two_scenes());
  s.subscribe(test::vertices_of("main", "other", 100.0), 1);
  s.sink->wait_for(1, 1);
  ASSERT_TRUE(s.stage.edit(stage::SetActor{"square", nullptr}));
  s.stage.act(seek_to(1.0), "other");
  const auto packets = s.sink->wait_until(1, [](const Packet& p) { return p.header.media_us == 1'000'000; });
  EXPECT_EQ(packets.back()->payload.floats()[1], 1.0F);
  ASSERT_TRUE(s.stage.undo());
  s.stage.act(seek_to(1.5), "other");
  EXPECT_EQ(s.sink->wait_until(1, [](const Packet& p) { return p.header.media_us == 1'500'000; }).back()->payload.floats()[1],
            1.5F);
  EXPECT_EQ(s.sink->ends(), 0U);
}

/// Has the hub call back after a view is delivered, and carries the word to the sinks' thread as an event would be.
/// The value: how many packets of each stream had come by then.
std::future<std::vector<std::vector<PacketPtr>>> after_delivery(Streaming& s, const stage::SceneViewPtr& view,
                                                                std::vector<std::uint32_t> streams) {
  auto promise = std::make_shared<std::promise<std::vector<std::vector<PacketPtr>>>>();
  auto future = promise->get_future();
  s.stage->post([&s, view, streams = std::move(streams), promise] {
    s.hub.after_delivery(view, [&s, streams, promise] {
      s.delivery.post([&s, streams, promise] {
        std::vector<std::vector<PacketPtr>> seen;
        for (const std::uint32_t stream : streams) seen.push_back(s.sink->packets(stream));
        promise->set_value(std::move(seen));
      });
    });
  });
  return future;
}

TEST(HubAfterDelivery, WaitsForThePacketsThatShowTheView) {
  Streaming s(two_scenes());
  const StreamKey slower = test::vertices_of("main", "square", 20.0);
  s.subscribe(kSquare, 1);
  s.subscribe(slower, 2);
  s.sink->wait_for(1, 1);
  s.sink->wait_for(2, 1);
  for (int round = 1; round <= 5; ++round) {
    const double time_s = 0.1 * round;
    const auto answer = s.stage.act(seek_to(time_s));
    const auto seen = after_delivery(s, answer.view, {1, 2}).get();
    for (const auto& packets : seen) {
      ASSERT_FALSE(packets.empty());
      EXPECT_EQ(packets.back()->header.media_us, std::llround(time_s * 1e6)) << "in round " << round;
    }
  }
}

TEST(HubAfterDelivery, ComesAtOnceWhereNobodyLooks) {
  Streaming s(two_scenes());
  s.subscribe(test::vertices_of("aside", "square", 0.01), 1);  // another scene
  const auto answer = s.stage.act(seek_to(0.5));
  after_delivery(s, answer.view, {}).get();
}

TEST(HubAfterDelivery, ComesAtOnceWhereTheViewHasBeenShown) {
  Streaming s(two_scenes());
  const auto answer = s.stage.act(seek_to(0.5));
  s.subscribe(kSquare, 1);
  s.sink->wait_for(1, 1);
  EXPECT_EQ(after_delivery(s, answer.view, {1}).get()[0].size(), 1U);
}

TEST(HubAfterDelivery, DoesNotWaitForWhoHasLeft) {
  Streaming s(two_scenes());
  const StreamKey slow = test::vertices_of("main", "square", 0.01);
  s.subscribe(slow, 1);
  s.sink->wait_for(1, 1);
  const auto answer = s.stage.act(seek_to(0.5));
  auto told = after_delivery(s, answer.view, {});
  s.unsubscribe(slow, 1);
  told.get();
}

TEST(HubAfterDelivery, DoesNotWaitForAnActorThatIsRemoved) {
  Streaming s(two_scenes());
  s.subscribe(test::vertices_of("main", "square", 0.01), 1);
  s.sink->wait_for(1, 1);
  const auto answer = s.stage.act(seek_to(0.5));
  auto told = after_delivery(s, answer.view, {});
  ASSERT_TRUE(s.stage.edit(stage::SetActor{"square", nullptr}));
  told.get();
}

// Who asks for a packet a minute is not waited for by all who hear of an end.
TEST(HubAfterDelivery, DoesNotWaitForASlowViewer) {
  Streaming s(two_scenes());
  s.subscribe(test::vertices_of("main", "square", 1e-9), 1);  // none by chance: the grid's next reading is decades away
  s.subscribe(kSquare, 2);
  s.sink->wait_for(1, 1);
  s.sink->wait_for(2, 1);
  const auto answer = s.stage.act(seek_to(0.5));
  const auto seen = after_delivery(s, answer.view, {1, 2}).get();
  EXPECT_EQ(seen[0].size(), 1U);
  EXPECT_EQ(seen[1].back()->header.media_us, 500'000);
}

TEST(HubAfterDelivery, DoesNotWaitForAViewerWhoBecameSlow) {
  Streaming s(two_scenes(), 1);
  const StreamKey slow = test::vertices_of("main", "square", 0.01);
  s.subscribe(kSquare, 1);
  s.sink->wait_for(1, 1);
  std::promise<void> go;  // the only worker waits for it: nothing is delivered
  s.workers.post([gone = go.get_future().share()] { gone.wait(); });
  auto told = after_delivery(s, s.stage.act(seek_to(0.5)).view, {});
  s.stage->post([&] { s.hub.retune(kSquare, slow, {s.sink, 1}); });
  s.settle();
  EXPECT_EQ(told.wait_for(std::chrono::seconds(0)), std::future_status::ready);
  go.set_value();
  told.get();
  s.unsubscribe(slow, 1);
  s.settle();
}

TEST(HubAfterDelivery, ComesInTheOrderOfTheViews) {
  Streaming s(two_scenes());
  s.subscribe(kSquare, 1);
  std::vector<int> order;  // the strand's own
  for (int i = 0; i < 20; ++i) {
    const auto answer = s.stage.act(seek_to(0.01 * i));
    s.stage->post([&s, &order, view = answer.view, i] { s.hub.after_delivery(view, [&order, i] { order.push_back(i); }); });
  }
  after_delivery(s, s.stage.view(), {}).get();
  s.settle();
  ASSERT_EQ(order.size(), 20U);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(HubAfterDelivery, OfOneSceneIsNotHeldUpByAnother) {
  Streaming s(two_scenes());
  s.subscribe(test::vertices_of("aside", "square", 0.01), 1);
  s.sink->wait_for(1, 1);
  const auto aside = s.stage.act(seek_to(0.5), {}, "aside");  // shown in a hundred seconds
  auto late = after_delivery(s, aside.view, {});
  const auto main = s.stage.act(seek_to(0.5));
  auto soon = after_delivery(s, main.view, {});
  s.settle();
  s.settle();
  EXPECT_EQ(soon.wait_for(std::chrono::seconds(0)), std::future_status::ready) << "nobody looks at this scene";
  s.unsubscribe(test::vertices_of("aside", "square", 0.01), 1);
  late.get();
}

// playback.ended says that the final value has been sent.
TEST(HubAfterDelivery, LetsTheWordOfAnEndFollowItsLastPacket) {
  Streaming s({scene_of("main", {square_actor("square", {{.keys = 2, .spacing_s = 0.02}})})});
  std::promise<std::vector<PacketPtr>> told;
  s.stage->post([&] {
    s.stage.on_ended = [&](const stage::SceneViewPtr& view) {
      s.hub.after_delivery(view, [&] { s.delivery.post([&] { told.set_value(s.sink->packets(1)); }); });
    };
  });
  s.subscribe(kSquare, 1);
  s.stage.act([](Player& player, const PlayRange& range, ClockUs now_us) {
    player.set_loop(range, Loop::Once, now_us);
    player.play(range, now_us);
  });
  const auto packets = told.get_future().get();
  ASSERT_FALSE(packets.empty());
  EXPECT_EQ(packets.back()->header.media_us, 20'000);
  EXPECT_EQ(packets.back()->header.flags, protocol::kFlagKey | protocol::kFlagLast);
}

TEST(HubStop, CallsWhoeverStillWaits) {
  Streaming s(two_scenes());
  s.subscribe(test::vertices_of("main", "square", 0.01), 1);
  s.sink->wait_for(1, 1);
  const auto answer = s.stage.act(seek_to(0.5));
  auto told = after_delivery(s, answer.view, {});
  s.stage->post([&] { s.hub.stop(); });
  told.get();
}

TEST(Hub, SurvivesManyComingsAndGoingsWhileAllMoves) {
  Streaming s(two_scenes());
  s.stage.act(&Player::play);
  s.stage.act(&Player::play, {}, "aside");
  const std::vector<StreamKey> keys{kSquare, test::vertices_of("main", "other", 240.0),
                                    test::vertices_of("aside", "square", 240.0), test::vertices_of("main", "square", 240.0)};
  for (std::uint32_t i = 0; i < 400; ++i) {
    s.subscribe(keys[i % keys.size()], i);
    if (i >= 10) s.unsubscribe(keys[(i - 10) % keys.size()], i - 10);
    if (i % 50 == 0) s.stage.act(seek_to(0.001 * i));
  }
  for (std::uint32_t i = 390; i < 400; ++i) s.sink->wait_for(i, 2);
  for (std::uint32_t i = 390; i < 400; ++i) s.unsubscribe(keys[i % keys.size()], i);
  EXPECT_EQ(producers(s), 0);
}

}  // namespace
}  // namespace tweend::streams
