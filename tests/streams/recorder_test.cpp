#include "server/streams/recorder.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/streams/still.hpp"
#include "tests/streams/picturing.hpp"

namespace tweend::streams {
namespace {

using test::Decoded;
using test::kSmall;

constexpr ClockUs kFrameUs = 20'000;  ///< of most recordings here

/// What came of a recording's pictures, and a gate that they wait at.
struct Kept {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<Decoded> pictures;
  bool open = true;
  bool finished = false, gone = false;
  std::thread::id gone_on;
  std::size_t fails_at = SIZE_MAX;

  void wait_for(std::size_t count) {
    std::unique_lock lock(mutex);
    ASSERT_TRUE(changed.wait_for(lock, test::kPatience, [&] { return pictures.size() >= count; }));
  }
  void let_through() {
    const std::lock_guard lock(mutex);
    open = true;
    changed.notify_all();
  }
};

class KeptSink final : public PictureSink {
 public:
  explicit KeptSink(std::shared_ptr<Kept> kept) : kept_(std::move(kept)) {}
  ~KeptSink() override {
    const std::lock_guard lock(kept_->mutex);
    kept_->gone = true;
    kept_->gone_on = std::this_thread::get_id();
    kept_->changed.notify_all();
  }
  Status add(const render::ImageView& image) override {
    std::unique_lock lock(kept_->mutex);
    kept_->changed.wait(lock, [this] { return kept_->open; });
    if (kept_->pictures.size() == kept_->fails_at) return fail(ErrorCode::Unavailable, "no space left");
    kept_->pictures.push_back(test::decoded(image));
    kept_->changed.notify_all();
    return {};
  }
  Result<std::uint64_t> finish() override {
    const std::lock_guard lock(kept_->mutex);
    kept_->finished = true;
    return 7;
  }

 private:
  const std::shared_ptr<Kept> kept_;
};

class Recorders : public testing::Test {
 protected:
  Recorders() : stage({test::scene_of("main", {test::square_actor("square", {{.keys = 40}})})}) {
    limits.recordings = 3;
    stage.start([this](const std::string& scene, const stage::SceneViewPtr& view) { recorder.follow(scene, view); });
  }
  ~Recorders() override {
    if (!finished_) recorder.finish_all();
    renderer.stop();
    workers.stop();
    stage.stop();
  }
  void SetUp() override {
    if (!renderer.device()) GTEST_SKIP() << renderer.device().error().message;
  }

  Result<RecordingStarted> try_start(const std::shared_ptr<Kept>& kept, const std::string& name, const std::string& scene,
                                     double fps = 50.0) {
    std::promise<Result<RecordingStarted>> promise;
    stage->post([&] {
      const auto id = recorder.reserve({scene, name, fps, kSmall, test::from_above()});
      promise.set_value(id ? recorder.start(*id, std::make_unique<KeptSink>(kept)) : Result<RecordingStarted>(id.error()));
    });
    return promise.get_future().get();
  }
  RecordingStarted start(const std::shared_ptr<Kept>& kept, const std::string& name = "a", double fps = 50.0) {
    const auto started = try_start(kept, name, "main", fps);
    EXPECT_TRUE(started) << started.error().message;
    return *started;
  }
  std::future<Result<Recorded>> stop_later(RecordingId id) {
    auto promise = std::make_shared<std::promise<Result<Recorded>>>();
    auto future = promise->get_future();
    stage->post([this, id, promise] {
      recorder.stop(id, [promise](Result<Recorded> recorded) { promise->set_value(std::move(recorded)); });
    });
    return future;
  }
  Result<Recorded> stop(RecordingId id) { return stop_later(id).get(); }
  void finish_all() {
    recorder.finish_all();
    finished_ = true;
  }
  Decoded picture_at(const stage::SceneViewPtr& view, ClockUs at_us) {
    StillRequest request;
    request.view = view;
    request.now_us = at_us;
    request.size = kSmall;
    request.camera = test::from_above();
    std::promise<Result<DrawnStill>> promise;
    draw_still(std::move(request), workers, renderer,
               [&promise](Result<DrawnStill> drawn) { promise.set_value(std::move(drawn)); });
    const auto drawn = promise.get_future().get();
    EXPECT_TRUE(drawn);
    return drawn ? test::decoded(drawn->pixels->view()) : Decoded{};
  }
  template <class Ask>
  auto on_strand(Ask ask) {
    std::promise<decltype(ask())> promise;
    stage->post([&] { promise.set_value(ask()); });
    return promise.get_future().get();
  }
  /// Has the playing begin by itself, as soon as this machine can say so beforehand. @return when
  ClockUs play_soon() {
    const auto plays = [this](ClockUs as_of_us, const stage::EditDone&) {
      const auto turn = test::RunningStage::every_player(
          [](stage::Player& player, const stage::PlayRange& range, ClockUs now_us) { player.play(range, now_us); });
      stage->carry_out("main", turn, as_of_us, [](const Result<stage::PlayersAnswer>&) {});
    };
    for (ClockUs ahead_us = 60'000;; ahead_us *= 2) {
      const ClockUs at_us = steady_now_us() + ahead_us;
      std::promise<bool> taken;
      stage->schedule(
          "main", "playback.play", {at_us, true}, plays, [](stage::ScheduledId, ClockUs) { return std::string(); },
          [&taken](const Result<std::string>& answer) { taken.set_value(answer.has_value()); });
      if (taken.get_future().get()) return at_us;  // else it was past already
    }
  }
  void play() {
    stage.act([](stage::Player& player, const stage::PlayRange& range, ClockUs now_us) { player.play(range, now_us); });
  }

  Limits limits;
  test::RunningStage stage;
  WorkerPool workers{3};
  render::RenderThread renderer;
  Recorder recorder{*stage, workers, renderer, limits, stage.metrics};

 private:
  bool finished_ = false;
};

TEST_F(Recorders, RefuseAnUnknownSceneATakenNameAndOneTooMany) {
  const auto kept = std::make_shared<Kept>();
  const auto nowhere = try_start(kept, "a", "nowhere");
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().code, ErrorCode::NotFound);
  start(kept, "a");
  const auto taken = try_start(kept, "a", "main");
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().code, ErrorCode::Conflict);
  start(kept, "b");
  start(kept, "c");
  const auto more = try_start(kept, "d", "main");
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().code, ErrorCode::Limit);
}

TEST_F(Recorders, LetTheSinkOfARefusedOneGoOffTheStrand) {
  ASSERT_TRUE(stage.wait(stage.create_later({"two", "scene.create", {}, {}})));
  const auto id = on_strand([this] { return recorder.reserve({"two", "a", 50.0, kSmall, {}}); });
  ASSERT_TRUE(id);
  ASSERT_TRUE(stage.wait(stage.remove_later({"two", "scene.remove", {}, {}})));
  const auto refused = std::make_shared<Kept>();
  const auto started = on_strand([&] { return recorder.start(*id, std::make_unique<KeptSink>(refused)); });
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, ErrorCode::NotFound);
  const std::thread::id strand = on_strand([] { return std::this_thread::get_id(); });
  std::unique_lock lock(refused->mutex);
  ASSERT_TRUE(refused->changed.wait_for(lock, test::kPatience, [&] { return refused->gone; }));
  EXPECT_NE(refused->gone_on, strand);
  EXPECT_FALSE(refused->finished);
  EXPECT_EQ(stage.metrics.recordings.load(), 0);
}

// Many that ask at once would each make an encoder before the first of them has begun.
TEST_F(Recorders, KeepAPlaceAndANameWhileTheSinkIsMade) {
  const auto reserve = [this](const std::string& name) {
    return on_strand([&] { return recorder.reserve({"main", name, 50.0, kSmall, {}}); });
  };
  const auto a = reserve("a"), b = reserve("b");
  ASSERT_TRUE(a && b);
  EXPECT_EQ(reserve("a").error().code, ErrorCode::Conflict);
  ASSERT_TRUE(reserve("c"));
  const Error more = reserve("d").error();
  EXPECT_EQ(more.code, ErrorCode::Limit);
  EXPECT_NE(more.message.find("(1, 2, 3)"), std::string::npos) << more.message;
  EXPECT_EQ(stop(*a).error().code, ErrorCode::NotFound) << "it has not begun";
  EXPECT_TRUE(on_strand([this] { return recorder.list(); }).empty());
  on_strand([&] { return recorder.release(*a), true; });
  EXPECT_TRUE(reserve("a")) << "there was no sink for it";
}

TEST_F(Recorders, ListWhatRunsIsEndingAndHasEndedByItself) {
  limits.recorded_pictures = 2;
  const auto kept = std::make_shared<Kept>(), broken = std::make_shared<Kept>(), held = std::make_shared<Kept>();
  broken->fails_at = 1;
  for (const auto& one : {kept, broken, held}) one->open = false;
  const auto list = [this] { return on_strand([this] { return recorder.list(); }); };
  const auto until_state = [&](std::size_t i, RecordingState state) {
    for (auto now = list();; now = list()) {
      if (now.at(i).state == state) return now;
      std::this_thread::yield();
    }
  };
  const auto done = start(kept, "done"), failed = start(broken, "failed"), slow = start(held, "slow", 0.01);
  EXPECT_EQ(stage.metrics.recordings.load(), 3);
  EXPECT_EQ(list()[2].state, RecordingState::Running);
  kept->let_through();
  broken->let_through();
  auto stopped = stop_later(slow.id);
  until_state(0, RecordingState::Done);
  until_state(1, RecordingState::Failed);
  const auto now = until_state(2, RecordingState::Ending);
  EXPECT_EQ(stage.metrics.recordings.load(), 1);
  EXPECT_EQ(now[0].id, done.id);
  EXPECT_EQ(now[0].name, "done");
  EXPECT_EQ(now[0].scene, "main");
  EXPECT_EQ(now[0].pictures, 2U);
  EXPECT_EQ(now[0].start_us, done.start_us);
  EXPECT_EQ(now[2].fps, 0.01);
  EXPECT_EQ(now[2].pictures, 0U);
  held->let_through();
  ASSERT_TRUE(stopped.get());
  EXPECT_TRUE(stop(done.id));
  EXPECT_FALSE(stop(failed.id));
  EXPECT_TRUE(list().empty());
}

TEST_F(Recorders, TellAllWhoStopOne) {
  const auto kept = std::make_shared<Kept>();
  kept->open = false;
  const auto started = start(kept);
  auto first = stop_later(started.id), second = stop_later(started.id);
  stage.settle();
  EXPECT_NE(second.wait_for(std::chrono::seconds(0)), std::future_status::ready);
  kept->let_through();
  const auto told = first.get(), again = second.get();
  ASSERT_TRUE(told && again);
  EXPECT_EQ(told->pictures, again->pictures);
}

// What acts by the clock acts as of its reading, however late: no picture may be drawn before that is known.
TEST_F(Recorders, ShowWhatActsByItselfThoughTheStrandIsLate) {
  const auto kept = std::make_shared<Kept>();
  const stage::SceneViewPtr before = stage.view();
  const auto started = start(kept);
  kept->wait_for(1);
  const ClockUs at_us = play_soon();
  // The strand is held until long after that, and the stop comes before its timer.
  stage->post([at_us] {
    while (steady_now_us() < at_us + 250'000) std::this_thread::yield();
  });
  const auto recorded = stop(started.id);
  ASSERT_TRUE(recorded);
  const stage::SceneViewPtr after = stage.view();
  ASSERT_EQ((*after->players)[0].anchor_us, at_us);
  ASSERT_GE(started.start_us + static_cast<ClockUs>(kept->pictures.size()) * kFrameUs, at_us + 200'000);
  for (std::size_t k = 0; k < kept->pictures.size(); ++k) {
    const ClockUs reading_us = started.start_us + static_cast<ClockUs>(k) * kFrameUs;
    const Decoded want = picture_at(reading_us < at_us ? before : after, reading_us);
    EXPECT_EQ(test::mean_difference(kept->pictures[k], want), 0.0) << k;
  }
}

TEST_F(Recorders, EndWhereMoreChangesWaitThanAreKept) {
  const auto kept = std::make_shared<Kept>();
  kept->open = false;
  // So many pictures a second that each of a few changes has its own.
  const auto started = start(kept, "a", 1e6);
  std::promise<void> turned;
  stage->post([&] {
    const auto turn = test::RunningStage::every_player(
        [](stage::Player& player, const stage::PlayRange& range, ClockUs now_us) { player.seek(range, 0.5, now_us); });
    for (std::size_t i = 0; i < RecordedViews::kMostKept + 10; ++i) {
      const ClockUs now_us = steady_now_us();
      while (steady_now_us() < now_us + 2) {
      }
      stage->carry_out("main", turn, steady_now_us(), [](const Result<stage::PlayersAnswer>&) {});
    }
    turned.set_value();
  });
  turned.get_future().wait();
  kept->let_through();
  const auto recorded = stop(started.id);
  ASSERT_FALSE(recorded);
  EXPECT_EQ(recorded.error().code, ErrorCode::Limit);
  const std::lock_guard lock(kept->mutex);
  EXPECT_TRUE(kept->gone);
  EXPECT_FALSE(kept->finished);
}

TEST_F(Recorders, StopOnlyWhatWasStartedAndOnce) {
  EXPECT_EQ(stop(1).error().code, ErrorCode::NotFound);
  const auto kept = std::make_shared<Kept>();
  const auto started = start(kept);
  kept->wait_for(1);
  const auto recorded = stop(started.id);
  ASSERT_TRUE(recorded) << recorded.error().message;
  EXPECT_EQ(recorded->name, "a");
  EXPECT_EQ(recorded->bytes, 7U);
  EXPECT_EQ(recorded->pictures, kept->pictures.size());
  EXPECT_TRUE(kept->finished && kept->gone);
  EXPECT_EQ(stop(started.id).error().code, ErrorCode::NotFound);
}

TEST_F(Recorders, MissNothingHoweverSlowTheEncoderIs) {
  const auto slow = std::make_shared<Kept>(), pace = std::make_shared<Kept>();
  slow->open = false;
  const stage::SceneViewPtr before = stage.view();
  const auto started = start(slow, "slow"), paced = start(pace, "pace");
  pace->wait_for(5);
  play();
  const stage::SceneViewPtr after = stage.view();
  const ClockUs played_us = (*after->players)[0].anchor_us;
  pace->wait_for(static_cast<std::size_t>((played_us - paced.start_us) / kFrameUs) + 26);  // half a second of it
  auto stopped = stop_later(started.id);
  ASSERT_TRUE(stop(paced.id));
  EXPECT_NE(stopped.wait_for(std::chrono::seconds(0)), std::future_status::ready) << "its pictures are still to be made";
  slow->let_through();
  const auto recorded = stopped.get();
  ASSERT_TRUE(recorded);
  ASSERT_EQ(recorded->pictures, slow->pictures.size());
  EXPECT_GE(slow->pictures.size(), 30U);
  std::size_t moved = 0;
  for (std::size_t k = 0; k < slow->pictures.size(); ++k) {
    const ClockUs at_us = started.start_us + static_cast<ClockUs>(k) * kFrameUs;
    const Decoded want = picture_at(at_us < played_us ? before : after, at_us);
    EXPECT_EQ(test::mean_difference(slow->pictures[k], want), 0.0) << k;
    if (k > 0 && test::mean_difference(slow->pictures[k], slow->pictures[k - 1]) > 0.0) ++moved;
  }
  EXPECT_GT(moved, 10U) << "there was something to be seen";
}

TEST_F(Recorders, EndWhereTheSceneIsRemovedAndKeepWhatThereIs) {
  ASSERT_TRUE(stage.wait(stage.create_later({"two", "scene.create", {}, {}})));
  const auto kept = std::make_shared<Kept>();
  const auto started = try_start(kept, "a", "two");
  ASSERT_TRUE(started);
  kept->wait_for(2);
  ASSERT_TRUE(stage.wait(stage.remove_later({"two", "scene.remove", {}, {}})));
  const auto recorded = stop(started->id);
  ASSERT_TRUE(recorded) << recorded.error().message;
  EXPECT_EQ(recorded->pictures, kept->pictures.size());
  EXPECT_TRUE(kept->finished);
}

TEST_F(Recorders, EndAfterSoManyPicturesAndLeaveTheirPlaceToOthers) {
  limits.recorded_pictures = 4;
  const auto kept = std::make_shared<Kept>();
  const auto started = start(kept);
  kept->wait_for(4);
  const auto recorded = stop(started.id);
  ASSERT_TRUE(recorded);
  EXPECT_EQ(recorded->pictures, 4U);
}

TEST_F(Recorders, TellWhatWentWrongWhenTheyAreStopped) {
  const auto kept = std::make_shared<Kept>();
  kept->fails_at = 2;
  const auto started = start(kept);
  kept->wait_for(2);
  const auto recorded = stop(started.id);
  ASSERT_FALSE(recorded);
  EXPECT_EQ(recorded.error().message, "no space left");
  EXPECT_TRUE(kept->gone);
  EXPECT_FALSE(kept->finished);
}

TEST_F(Recorders, MakeAFileOfWhatThereIsWhenTheServerStops) {
  const auto kept = std::make_shared<Kept>();
  const auto started = start(kept);
  kept->wait_for(3);
  finish_all();
  EXPECT_TRUE(kept->finished && kept->gone);
  EXPECT_GE(kept->pictures.size(), 3U);
  const auto recorded = stop(started.id);
  ASSERT_TRUE(recorded);
  EXPECT_EQ(recorded->pictures, kept->pictures.size());
  EXPECT_EQ(try_start(kept, "b", "main").error().code, ErrorCode::Unavailable);
}

}  // namespace
}  // namespace tweend::streams
