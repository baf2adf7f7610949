#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/stage/stage.hpp"
#include "tests/support/controlled_store.hpp"
#include "tests/support/scenes.hpp"

namespace tweend::test {

/// How long a test waits for what must come: only a broken server lets it run out.
inline constexpr std::chrono::seconds kPatience{60};

/// A stage that runs on a controlled store, what its listener was told, and calls that wait for the answer.
class RunningStage : public stage::StageListener {
 public:
  enum class Kind { Published, Edited, PlayersChanged, PlayerEnded, MarkersCrossed, ScheduleFailed };
  /// One call of the listener.
  struct Told {
    Kind kind;
    std::string scene;
    stage::SceneViewPtr view;                   ///< Published, PlayersChanged, PlayerEnded
    std::vector<std::size_t> players;           ///< PlayersChanged, PlayerEnded
    std::optional<stage::EditEvent> edit;       ///< Edited
    ClockUs at_us = 0;                          ///< PlayersChanged
    std::vector<stage::MarkerCrossed> crossed;  ///< MarkersCrossed
    std::optional<stage::Scheduled> scheduled;  ///< ScheduleFailed
    std::optional<Error> error;                 ///< ScheduleFailed
  };
  using Answer = Result<std::string>;

  explicit RunningStage(std::vector<model::ScenePtr> scenes = {}, const Limits& limits = {})
      : store(std::move(scenes)), stage_(std::make_unique<stage::Stage>(store, limits, metrics)) {}
  ~RunningStage() override { stop(); }
  RunningStage(const RunningStage&) = delete;
  RunningStage& operator=(const RunningStage&) = delete;

  /// @param on_published  is called first whenever a view is published
  void start(std::function<void(const std::string&, const stage::SceneViewPtr&)> on_published = {}) {
    on_published_ = std::move(on_published);
    ASSERT_TRUE(stage_->start(*this));
  }
  void stop() {
    store.release();  // a test that failed may have left it held
    stage_->stop();
  }
  stage::Stage& operator*() { return *stage_; }
  stage::Stage* operator->() { return stage_.get(); }

  [[nodiscard]] stage::SceneViewPtr view(std::string_view scene = "main") const { return stage_->view()->find(scene); }
  [[nodiscard]] std::uint64_t revision(std::string_view scene = "main") const { return view(scene)->scene->revision; }

  // Edits, as what their answers will be.

  std::future<Answer> edit_later(stage::EditOptions options, stage::EditPlan plan) {
    auto [done, future] = promised();
    stage_->edit(std::move(options), std::move(plan), std::move(done));
    return std::move(future);
  }
  std::future<Answer> move_later(stage::EditOptions options, stage::HistoryMove move) {
    auto [done, future] = promised();
    stage_->move_history(
        std::move(options), move,
        [](std::uint64_t revision, const std::string& method) { return method + " " + std::to_string(revision); },
        std::move(done));
    return std::move(future);
  }
  std::future<Answer> create_later(stage::EditOptions options) {
    auto [done, future] = promised();
    stage_->create_scene(
        std::move(options), [](std::uint64_t revision) { return "created " + std::to_string(revision); }, std::move(done));
    return std::move(future);
  }
  std::future<Answer> remove_later(stage::EditOptions options) {
    auto [done, future] = promised();
    stage_->remove_scene(
        std::move(options), [](std::uint64_t revision) { return "removed " + std::to_string(revision); }, std::move(done));
    return std::move(future);
  }

  static Answer wait(std::future<Answer> future) {
    if (future.wait_for(kPatience) == std::future_status::ready) return future.get();
    ADD_FAILURE() << "an edit was never answered";
    return fail(ErrorCode::Internal, "never answered");
  }
  Answer edit(stage::EditOptions options, stage::EditPlan plan) {
    return wait(edit_later(std::move(options), std::move(plan)));
  }
  /// An edit of one change to `main`; its answer is the new revision.
  Answer edit(stage::Change change) { return edit({"main", "test.edit", {}, {}}, applies(std::move(change))); }
  Answer undo(const std::string& scene = "main") {
    return wait(move_later({scene, "edit.undo", {}, {}}, stage::HistoryMove::Undo));
  }
  Answer redo(const std::string& scene = "main") {
    return wait(move_later({scene, "edit.redo", {}, {}}, stage::HistoryMove::Redo));
  }

  /// A plan of one change; its answer is the new revision.
  static stage::EditPlan applies(stage::Change change) {
    return [change = std::move(change)](stage::Transaction& t) -> Answer {
      t.apply(change);
      return std::to_string(t.revision());
    };
  }

  // Players

  std::future<Result<stage::PlayersAnswer>> change_players_later(std::string scene, stage::PlayersChange change) {
    auto promise = std::make_shared<std::promise<Result<stage::PlayersAnswer>>>();
    auto future = promise->get_future();
    stage_->change_players(std::move(scene), std::move(change),
                           [promise](Result<stage::PlayersAnswer> answer) { promise->set_value(std::move(answer)); });
    return future;
  }
  Result<stage::PlayersAnswer> change_players(std::string scene, stage::PlayersChange change) {
    auto future = change_players_later(std::move(scene), std::move(change));
    if (future.wait_for(kPatience) == std::future_status::ready) return future.get();
    ADD_FAILURE() << "a change of players was never answered";
    return fail(ErrorCode::Internal, "never answered");
  }
  using Act = std::function<void(stage::Player&, const stage::PlayRange&, ClockUs)>;
  /// Does the same to every player of a scene, or to those of one actor.
  static stage::PlayersChange every_player(Act act, std::optional<std::string> actor = {}) {
    return
        [act = std::move(act), actor = std::move(actor)](const stage::PlayersTurn& turn) -> Result<std::vector<std::size_t>> {
          std::vector<std::size_t> concerned;
          for (std::size_t i = 0; i < turn.players.size(); ++i) {
            stage::Player& player = turn.players[i];
            if (actor && player.actor != *actor) continue;
            act(player, player.range_of(*stage::clip_of(*turn.scene.actors[i], player)), turn.now_us);
            concerned.push_back(i);
          }
          return concerned;
        };
  }
  stage::PlayersAnswer act(Act act, std::optional<std::string> actor = {}, const std::string& scene = "main") {
    auto answer = change_players(scene, every_player(std::move(act), std::move(actor)));
    EXPECT_TRUE(answer);
    return answer ? *answer : stage::PlayersAnswer{};
  }

  /// Returns when everything that was posted to the strand before has been carried out.
  void settle() {
    std::promise<void> passed;
    stage_->post([&passed] { passed.set_value(); });
    passed.get_future().wait();
  }

  // What the listener was told

  [[nodiscard]] std::vector<Told> told() const {
    const std::lock_guard lock(mutex_);
    return told_;
  }
  [[nodiscard]] std::size_t count(Kind kind) const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(
        std::count_if(told_.begin(), told_.end(), [kind](const Told& t) { return t.kind == kind; }));
  }
  /// Waits until the listener was told so many of a kind since the test began.
  void wait_for(Kind kind, std::size_t count) {
    std::unique_lock lock(mutex_);
    const bool came = changed_.wait_for(lock, kPatience, [&] {
      return static_cast<std::size_t>(
                 std::count_if(told_.begin(), told_.end(), [kind](const Told& t) { return t.kind == kind; })) >= count;
    });
    ASSERT_TRUE(came) << "the listener was told less than expected";
  }
  void forget() {
    const std::lock_guard lock(mutex_);
    told_.clear();
  }

  void published(const std::string& scene, const stage::SceneViewPtr& v) override {
    if (on_published_) on_published_(scene, v);
    record({Kind::Published, scene, v, {}, {}, 0, {}, {}, {}});
  }
  void edited(const stage::EditEvent& event) override {
    record({Kind::Edited, event.scene, nullptr, {}, event, 0, {}, {}, {}});
  }
  void players_changed(const stage::SceneViewPtr& v, const std::vector<std::size_t>& concerned, ClockUs now_us) override {
    record({Kind::PlayersChanged, v->scene->name, v, concerned, {}, now_us, {}, {}, {}});
  }
  void player_ended(const stage::SceneViewPtr& v, std::size_t player) override {
    record({Kind::PlayerEnded, v->scene->name, v, {player}, {}, 0, {}, {}, {}});
    if (on_ended) on_ended(v);
  }

  void markers_crossed(const std::string& scene, const std::vector<stage::MarkerCrossed>& crossed) override {
    record({Kind::MarkersCrossed, scene, nullptr, {}, {}, 0, crossed, {}, {}});
  }
  void schedule_failed(const stage::Scheduled& scheduled, const Error& error) override {
    record({Kind::ScheduleFailed, scheduled.scene, nullptr, {}, {}, 0, {}, scheduled, error});
  }

  /// Called on the strand; set before start().
  std::function<void(const stage::SceneViewPtr&)> on_ended;
  Metrics metrics;
  ControlledStore store;

 private:
  static std::pair<stage::EditDone, std::future<Answer>> promised() {
    auto promise = std::make_shared<std::promise<Answer>>();
    auto future = promise->get_future();
    return {[promise](Answer answer) { promise->set_value(std::move(answer)); }, std::move(future)};
  }
  void record(Told told) {
    {
      const std::lock_guard lock(mutex_);
      told_.push_back(std::move(told));
    }
    changed_.notify_all();
  }

  std::unique_ptr<stage::Stage> stage_;
  std::function<void(const std::string&, const stage::SceneViewPtr&)> on_published_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Told> told_;
};

}  // namespace tweend::test
