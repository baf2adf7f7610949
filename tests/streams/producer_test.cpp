#include "server/streams/producer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "server/model/evaluate.hpp"
#include "tests/streams/streaming.hpp"

namespace tweend::streams {
namespace {

using protocol::kFlagDiscontinuity;
using protocol::kFlagKey;
using protocol::kFlagLast;
using stage::Loop;
using stage::Player;
using stage::PlayRange;
using test::RunningStage;
using test::scene_of;
using test::square_actor;
using test::square_at;
using test::Streaming;

constexpr std::uint32_t kStream = 7;
constexpr std::size_t kAWhile = 12;  ///< packets of another stream, at 240 a second

/// A square with keyframes at 0, 1 and 2 s, and a witness that moves all the time.
std::vector<model::ScenePtr> square_and_witness() {
  return {scene_of("main", {square_actor("square"), square_actor("witness", {{.spacing_s = 1000.0}})})};
}
const StreamKey kSquare = test::vertices_of("main", "square", 200.0);
const StreamKey kWitness = test::vertices_of("main", "witness", 240.0);

RunningStage::Act seek_to(double time_s) {
  return [time_s](Player& player, const PlayRange& range, ClockUs now_us) { player.seek(range, time_s, now_us); };
}

/// What the actor shows at a time of its first clip, as a payload.
std::vector<float> vertices_at(const stage::SceneViewPtr& view, const std::string& actor, double time_s) {
  const model::ActorPtr at = view->scene->find_actor(actor);
  std::vector<float> block(6 * at->model->mesh->vertex_count());
  const std::span<float> out(block);
  EXPECT_TRUE(model::Evaluator().vertices(*at, model::shown_clip(at->clips[0], time_s),
                                          {out.first(block.size() / 2), out.subspan(block.size() / 2), {}}));
  return block;
}

TEST(Producer, SendsTheFirstPacketAtOnceWithAllItsFields) {
  Streaming s(square_and_witness());
  s.stage.act(seek_to(1.25), "square");
  const ClockUs before_us = steady_now_us();
  s.subscribe(kSquare, kStream);
  const PacketPtr packet = s.sink->wait_for(kStream, 1)[0];
  EXPECT_EQ(packet->header.kind, protocol::PacketKind::Vertices);
  EXPECT_EQ(packet->header.encoding, protocol::kVerticesF32);
  EXPECT_EQ(packet->header.flags, kFlagKey | kFlagLast) << "it rests, and the first packet breaks nothing";
  EXPECT_EQ(packet->header.sequence, 0U);
  EXPECT_EQ(packet->header.media_us, 1'250'000);
  EXPECT_GE(packet->header.server_us, before_us);
  EXPECT_LE(packet->header.server_us, steady_now_us());
  EXPECT_EQ(packet->header.revision, 0U);
  EXPECT_EQ(packet->header.payload_bytes, 4U * 6U * 4U);
  EXPECT_EQ(packet->payload.bytes().size(), packet->header.payload_bytes);
  EXPECT_EQ(test::floats_of(*packet), vertices_at(s.stage.view(), "square", 1.25));
  EXPECT_NE(packet->source, 0U);
}

TEST(Producer, CountsOnlyWhatItProduced) {
  Streaming s(square_and_witness());
  s.subscribe(kSquare, kStream);
  s.sink->wait_for(kStream, 1);
  s.settle();
  EXPECT_EQ(s.stage.metrics.packets_produced_total.load(), 1);
}

TEST(Producer, IsSilentAfterThePacketThatShowsTheFinalState) {
  Streaming s(square_and_witness());
  s.subscribe(kSquare, kStream);
  s.stage.act(&Player::play, "witness");
  s.let_pass(kWitness, kAWhile);
  const auto before = s.sink->wait_for(kStream, 1);
  EXPECT_EQ(before.back()->header.flags & kFlagLast, kFlagLast);
  s.let_pass(kWitness, kAWhile);
  EXPECT_EQ(s.sink->packets(kStream).size(), before.size());
}

TEST(Producer, IsSilentWhileOnlyAnotherActorIsPlayedAndSought) {
  Streaming s(square_and_witness());
  s.subscribe(kSquare, kStream);
  s.sink->wait_for(kStream, 1);
  s.stage.act(&Player::play, "witness");
  s.stage.act(seek_to(700.0), "witness");
  s.let_pass(kWitness, kAWhile);
  EXPECT_EQ(s.sink->packets(kStream).size(), 1U) << "what this stream shows has not changed since its flag 4";
}

TEST(Producer, GivesALateJoinerTheLatestPacketAndTheOthersNone) {
  Streaming s(square_and_witness());
  s.subscribe(kSquare, kStream);
  const PacketPtr first = s.sink->wait_for(kStream, 1)[0];
  s.subscribe(kSquare, kStream + 1);
  s.settle();
  const auto late = s.sink->packets(kStream + 1);
  ASSERT_EQ(late.size(), 1U) << "at once: it was there when the subscription was";
  EXPECT_EQ(late[0], first) << "the very same packet";
  s.stage.act(&Player::play, "witness");
  EXPECT_EQ(s.sink->packets(kStream).size(), 1U);
}

TEST(Producer, GivesALateJoinerOfAMovingStreamTheLatestPacketAndThenTheSameAsTheOthers) {
  Streaming s(square_and_witness());
  s.stage.act(&Player::play, "witness");
  s.subscribe(kWitness, 1);
  s.sink->wait_for(1, 3);
  s.subscribe(kWitness, 2);
  const auto late = s.sink->wait_for(2, 5);
  s.unsubscribe(kWitness, 1);
  s.unsubscribe(kWitness, 2);
  s.settle();
  const auto all = s.sink->packets(1);
  const auto from = std::find(all.begin(), all.end(), late[0]);
  ASSERT_NE(from, all.end());
  for (std::ptrdiff_t i = 0; i < 5 && i < all.end() - from; ++i) EXPECT_EQ(late[static_cast<std::size_t>(i)], from[i]);
  EXPECT_GE(late[0]->header.sequence, 2U);
}

TEST(Producer, GivesALateJoinerAPacketAtOnceAlsoWhileAChangeWaitsForItsTurn) {
  Streaming s(square_and_witness());
  const StreamKey slow = test::vertices_of("main", "square", 1e-9);  // a packet in decades: the grid's next is far off
  s.subscribe(slow, kStream);
  const PacketPtr first = s.sink->wait_for(kStream, 1)[0];
  s.stage.act(seek_to(1.0), "square");
  s.subscribe(slow, kStream + 1);
  s.settle();
  const auto late = s.sink->packets(kStream + 1);
  ASSERT_EQ(late.size(), 1U) << "a new stream gets the producer's latest right away";
  EXPECT_EQ(late[0], first);
}

TEST(Producer, ShowsASeekInOnePacket) {
  Streaming s(square_and_witness());
  s.subscribe(kSquare, kStream);
  s.sink->wait_for(kStream, 1);
  s.stage.act(seek_to(1.5), "square");
  const PacketPtr sought = s.sink->wait_for(kStream, 2)[1];
  EXPECT_EQ(sought->header.flags, kFlagKey | kFlagDiscontinuity | kFlagLast);
  EXPECT_EQ(sought->header.media_us, 1'500'000);
  EXPECT_EQ(sought->header.sequence, 1U);
  EXPECT_EQ(test::floats_of(*sought), vertices_at(s.stage.view(), "square", 1.5));
  s.subscribe(kWitness, 1);
  s.sink->wait_for(1, 1);
  EXPECT_EQ(s.sink->packets(kStream).size(), 2U);
}

TEST(Producer, ShowsTheLastOfManySeeks) {
  Streaming s(square_and_witness());
  s.subscribe(kSquare, kStream);
  for (int i = 1; i <= 100; ++i) s.stage.act(seek_to(i / 100.0), "square");
  const auto packets = s.sink->wait_until(kStream, [](const Packet& p) { return p.header.media_us == 1'000'000; });
  for (std::size_t i = 0; i < packets.size(); ++i) {
    EXPECT_EQ(packets[i]->header.sequence, i);
    if (i > 0) {
      EXPECT_EQ(packets[i]->header.flags & kFlagDiscontinuity, kFlagDiscontinuity);
      EXPECT_GT(packets[i]->header.media_us, packets[i - 1]->header.media_us);
    }
  }
  EXPECT_EQ(packets.back()->header.flags & kFlagLast, kFlagLast);
}

TEST(Producer, SendsTheTimeThatHoldsAtTheReadingItTells) {
  Streaming s(square_and_witness());
  s.subscribe(kWitness, kStream);
  s.sink->wait_for(kStream, 1);
  const ClockUs started_us = s.stage.act(&Player::play, "witness").now_us;
  s.sink->wait_for(kStream, 30);
  s.unsubscribe(kWitness, kStream);
  s.settle();
  const auto packets = s.sink->packets(kStream);
  for (std::size_t i = 1; i < packets.size(); ++i) {
    const protocol::PacketHeader& header = packets[i]->header;
    EXPECT_EQ(header.sequence, i);
    EXPECT_EQ(header.flags, kFlagKey);
    EXPECT_GT(header.server_us, packets[i - 1]->header.server_us);
    EXPECT_NEAR(static_cast<double>(header.media_us), static_cast<double>(header.server_us - started_us), 2.0);
    const double time_s = seconds_between(started_us, header.server_us);
    EXPECT_NEAR(packets[i]->payload.floats()[1], time_s / 1000.0, 1e-5) << "the height of the first vertex: a metre in 1000 s";
  }
}

TEST(Producer, ReadsTheClockOnAGrid) {
  Streaming s(square_and_witness());
  s.stage.act(&Player::play, "witness");
  const StreamKey key = test::vertices_of("main", "witness", 125.0);
  s.subscribe(key, kStream);
  s.sink->wait_for(kStream, 20);
  s.unsubscribe(key, kStream);
  s.settle();
  // A machine that was away for a whole period reads at once instead.
  if (s.stage.metrics.ticks_missed_total.load() != 0) return;
  const auto packets = s.sink->packets(kStream);
  for (std::size_t i = 2; i < packets.size(); ++i) {  // the first came at once, off the grid
    EXPECT_EQ((packets[i]->header.server_us - packets[1]->header.server_us) % 8000, 0) << i;
  }
}

TEST(Producer, EndsAPauseWithAPacketOfThePausedTime) {
  Streaming s(square_and_witness());
  s.subscribe(kWitness, kStream);
  s.stage.act(&Player::play, "witness");
  s.sink->wait_for(kStream, 5);
  const stage::PlayersAnswer paused = s.stage.act(&Player::pause, "witness");
  const auto packets =
      s.sink->wait_until(kStream, [](const Packet& p) { return p.header.media_us > 0 && (p.header.flags & kFlagLast); });
  const double time_s = stage::show_at(*paused.view, paused.now_us).actors[1].time_s;
  EXPECT_EQ(packets.back()->header.media_us, std::llround(time_s * 1e6));
  EXPECT_EQ(packets.back()->header.flags, kFlagKey | kFlagLast) << "time has stopped, nothing has jumped";
  EXPECT_EQ(test::floats_of(*packets.back()), vertices_at(s.stage.view(), "witness", time_s));
  for (std::size_t i = 2; i + 1 < packets.size(); ++i) EXPECT_EQ(packets[i]->header.flags & kFlagLast, 0);
  s.stage.act(&Player::play, "square");
  s.let_pass(kSquare, kAWhile);
  EXPECT_EQ(s.sink->packets(kStream).back()->header.media_us, packets.back()->header.media_us);
}

TEST(Producer, GoesOnAfterAPauseFromThePausedTime) {
  Streaming s(square_and_witness());
  s.stage.act(&Player::play, "witness");
  s.stage.act(&Player::pause, "witness");
  s.subscribe(kWitness, kStream);
  const std::int64_t paused_us = s.sink->wait_for(kStream, 1)[0]->header.media_us;
  const ClockUs again_us = s.stage.act(&Player::play, "witness").now_us;
  const auto packets = s.sink->wait_for(kStream, 5);
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_NEAR(static_cast<double>(packets[i]->header.media_us - paused_us),
                static_cast<double>(packets[i]->header.server_us - again_us), 2.0);
    EXPECT_EQ(packets[i]->header.flags, kFlagKey);
  }
}

TEST(Producer, EndsAOnceWithThePacketOfItsEnd) {
  Streaming s({scene_of(
      "main", {square_actor("short", {{.keys = 2, .spacing_s = 0.05}}), square_actor("witness", {{.spacing_s = 1000.0}})})});
  const StreamKey key = test::vertices_of("main", "short", 240.0);
  s.subscribe(key, kStream);
  s.sink->wait_for(kStream, 1);
  s.stage.act(
      [](Player& player, const PlayRange& range, ClockUs now_us) {
        player.set_loop(range, Loop::Once, now_us);
        player.play(range, now_us);
      },
      "short");
  const auto packets = s.sink->wait_until(kStream, [](const Packet& p) { return p.header.media_us == 50'000; });
  EXPECT_EQ(packets.back()->header.flags, kFlagKey | kFlagLast);
  EXPECT_EQ(test::floats_of(*packets.back()), vertices_at(s.stage.view(), "short", 0.05));
  s.stage.wait_for(RunningStage::Kind::PlayerEnded, 1);
  s.let_pass(test::vertices_of("main", "short", 100.0), 1);
  for (const PacketPtr& p : s.sink->packets(kStream)) {
    if (p->header.sequence <= packets.back()->header.sequence) continue;
    EXPECT_EQ(p->header.media_us, 50'000);
  }
}

/// A short clip repeats: a packet is marked if it lies beyond a seam that breaks.
void expect_jumps_at_seams(bool closed) {
  Streaming s({scene_of("main", {square_actor("short", {{.keys = 2, .spacing_s = 0.01, .closed = closed}})})});
  const StreamKey key = test::vertices_of("main", "short", 240.0);
  s.subscribe(key, kStream);
  s.sink->wait_for(kStream, 1);
  const ClockUs started_us = s.stage.act(&Player::play).now_us;
  const auto packets = s.sink->wait_for(kStream, 40);
  const std::int64_t length_us = closed ? 20'000 : 10'000;
  std::size_t seams = 0;
  for (std::size_t i = 2; i < packets.size(); ++i) {
    const std::int64_t before_us = packets[i - 1]->header.server_us - started_us;
    const std::int64_t now_us = packets[i]->header.server_us - started_us;
    const auto near_seam = [&](std::int64_t us) { return us % length_us < 2 || us % length_us > length_us - 2; };
    if (near_seam(before_us) || near_seam(now_us)) continue;
    const bool wrapped = before_us / length_us != now_us / length_us;
    seams += wrapped ? 1 : 0;
    EXPECT_EQ((packets[i]->header.flags & kFlagDiscontinuity) != 0, wrapped && !closed) << "packet " << i;
  }
  EXPECT_GT(seams, 0U);
}

TEST(Producer, MarksTheWrapsOfAnOpenClip) { expect_jumps_at_seams(false); }
TEST(Producer, DoesNotMarkTheWrapsOfAClosedClip) { expect_jumps_at_seams(true); }

TEST(Producer, ShowsAnEditWithItsRevision) {
  Streaming s(square_and_witness());
  s.subscribe(kSquare, kStream);
  s.sink->wait_for(kStream, 1);
  const model::ActorPtr square = s.stage.view()->scene->actors[0];
  model::Keyframe first = square->clips[0]->keyframes[0];
  first.vertices = square_at(*square->model->mesh, -4.0F);
  ASSERT_TRUE(s.stage.edit(stage::SetKeyframe{"square", "default", first.id, stage::TimedKeyframe{0.0, first}}));
  const PacketPtr edited = s.sink->wait_for(kStream, 2)[1];
  EXPECT_EQ(edited->header.flags, kFlagKey | kFlagDiscontinuity | kFlagLast);
  EXPECT_EQ(edited->header.revision, 1U);
  EXPECT_EQ(edited->payload.floats()[1], -4.0F);
  EXPECT_EQ(test::floats_of(*edited), vertices_at(s.stage.view(), "square", 0.0));
}

TEST(Producer, NeverShowsAnEditThatIsNotDurable) {
  Streaming s(square_and_witness());
  s.stage.act(&Player::play, "witness");
  s.subscribe(kWitness, kStream);
  s.stage.store.hold();
  auto edit =
      s.stage.edit_later({"main", "test.edit", {}, {}}, RunningStage::applies(stage::SetSceneSettings{test::with_grid(true)}));
  s.stage.store.wait_for_commits(1);
  const std::size_t before = s.sink->packets(kStream).size();
  for (const PacketPtr& p : s.sink->wait_for(kStream, before + kAWhile)) EXPECT_EQ(p->header.revision, 0U);
  s.stage.store.release();
  ASSERT_TRUE(RunningStage::wait(std::move(edit)));
  const auto packets = s.sink->wait_until(kStream, [](const Packet& p) { return p.header.revision == 1; });
  EXPECT_EQ(packets.back()->header.flags, kFlagKey | kFlagDiscontinuity);
}

TEST(Producer, ShowsTheRestShapeOfAClipWithoutKeyframes) {
  Streaming s({scene_of("main", {square_actor("empty", {{.keys = 0}})})});
  s.subscribe(test::vertices_of("main", "empty", 30.0), kStream);
  const PacketPtr packet = s.sink->wait_for(kStream, 1)[0];
  EXPECT_EQ(packet->header.flags, kFlagKey | kFlagLast);
  EXPECT_EQ(packet->header.media_us, 0);
  const auto rest = s.stage.view()->scene->actors[0]->model->rest;
  EXPECT_TRUE(std::equal(rest->positions().begin(), rest->positions().end(), packet->payload.floats().begin()));
}

TEST(Producer, MarksAChangeOfClip) {
  Streaming s({scene_of("main", {square_actor("square", {{.name = "first"}, {.name = "second", .first_id = 10}})})});
  s.subscribe(kSquare, kStream);
  s.sink->wait_for(kStream, 1);
  s.stage.act([&](Player& player, const PlayRange&, ClockUs now_us) {
    player.change_clip(*s.stage.view()->scene->actors[0]->clips[1], now_us);
  });
  EXPECT_EQ(s.sink->wait_for(kStream, 2)[1]->header.flags, kFlagKey | kFlagDiscontinuity | kFlagLast);
}

}  // namespace
}  // namespace tweend::streams
