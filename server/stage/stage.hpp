#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "server/base/clock.hpp"
#include "server/base/limits.hpp"
#include "server/base/metrics.hpp"
#include "server/base/published.hpp"
#include "server/base/result.hpp"
#include "server/base/worker_pool.hpp"
#include "server/stage/history.hpp"
#include "server/stage/show.hpp"
#include "server/stage/transaction.hpp"
#include "server/store/commit_queue.hpp"

namespace tweend::stage {

/// An accepted and durable edit.
struct EditEvent {
  std::string scene;
  std::string method;
  std::uint64_t revision = 0;
  EditSubject subject;
};

/// A marker that a player has passed.
struct MarkerCrossed {
  std::string actor;
  std::string clip;
  model::Marker marker;
  ClockUs at_us = 0;
};

using ScheduledId = std::int64_t;

/// A command that waits for its reading.
struct Scheduled {
  ScheduledId id = 0;
  ClockUs at_us = 0;
  std::string method;
  std::string scene;
};

/// Told on the stage's strand, in order, after the view that shows it is published.
class StageListener {
 public:
  virtual ~StageListener() = default;
  /// @param view  null: the scene was removed
  virtual void published(const std::string& scene, const SceneViewPtr& view) = 0;
  virtual void edited(const EditEvent& event) = 0;
  /// @param concerned  indices into view.players
  virtual void players_changed(const SceneViewPtr& view, const std::vector<std::size_t>& concerned, ClockUs now_us) = 0;
  virtual void player_ended(const SceneViewPtr& view, std::size_t player) = 0;
  /// @param crossed  of one tick, in order of time
  virtual void markers_crossed(const std::string& scene, const std::vector<MarkerCrossed>& crossed) = 0;
  /// A command that was answered `scheduled` could not be carried out.
  virtual void schedule_failed(const Scheduled& scheduled, const Error& error) = 0;
};

/// What every edit may carry beside its own parameters.
struct EditOptions {
  std::string scene;
  std::string method;
  std::optional<std::uint64_t> base_revision;
  std::string retry_key;  ///< empty: none
};

/// Makes an edit: checks against the transaction's scene, applies changes, returns the result as JSON text. Pure but for the
/// transaction; may be called again on another head.
using EditPlan = std::function<Result<std::string>(Transaction&)>;
/// The result's JSON, once durable; or why nothing has changed. On the strand.
using EditDone = std::function<void(Result<std::string>)>;

/// A turn at the players of a scene: a copy, kept if the change succeeds.
struct PlayersTurn {
  const model::Scene& scene;
  Players& players;
  ClockUs now_us;
  const Limits& limits;
};
/// Indices of the players concerned.
using PlayersChange = std::function<Result<std::vector<std::size_t>>(const PlayersTurn&)>;
struct PlayersAnswer {
  SceneViewPtr view;
  std::vector<std::size_t> concerned;
  ClockUs now_us = 0;
};
using PlayersDone = std::function<void(Result<PlayersAnswer>)>;

/// When a command is to be carried out.
struct Timing {
  ClockUs at_us = 0;
  bool late_is_error = false;  ///< else one that comes too late is carried out as of then
};
/// Carries a command out as of a reading, on the strand; `done` is called once, with its answer.
using TimedAct = std::function<void(ClockUs as_of_us, EditDone done)>;
using ScheduledAnswer = std::function<std::string(ScheduledId, ClockUs at_us)>;

enum class HistoryMove : std::uint8_t { Undo, Redo };

/// All documents and players, owned by one strand (a thread of its own).
///
/// Edits are applied to a head at once and answered when the store has them; only then are they published. Whoever reads
/// takes the published view and never waits. A commit that fails drops the heads: every edit that waits is answered
/// Unavailable, and nothing has changed.
class Stage {
 public:
  Stage(store::DocumentStore& store, const Limits& limits, Metrics& metrics);
  ~Stage();  ///< stop()
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Loads the documents, makes sure that `main` exists, starts the threads. The listener must outlive stop().
  [[nodiscard]] Status start(StageListener& listener);
  /// Commits what waits, answers it, joins the threads.
  void stop();

  // Safe from any thread:

  [[nodiscard]] StageViewPtr view() const { return view_.load(); }
  /// The newest state of a scene, durable or not: what the next edit will be planned on. Null: no such scene.
  [[nodiscard]] model::ScenePtr head(std::string_view scene) const;

  // Safe from any thread; carried out on the strand in the order they come.

  void edit(EditOptions options, EditPlan plan, EditDone done);
  /// @param answer  makes the result from the new revision and the method that was undone or redone
  void move_history(EditOptions options, HistoryMove move, std::function<std::string(std::uint64_t, const std::string&)> answer,
                    EditDone done);
  void create_scene(EditOptions options, std::function<std::string(std::uint64_t)> answer, EditDone done);
  void remove_scene(EditOptions options, std::function<std::string(std::uint64_t)> answer, EditDone done);
  void change_players(std::string scene, PlayersChange change, PlayersDone done);
  /// Keeps a command for its reading, where that is to come; carries it out at once where it is past.
  /// @param done  the answer: `answer` at once, or the command's own
  void schedule(std::string scene, std::string method, Timing timing, TimedAct act, ScheduledAnswer answer, EditDone done);
  /// @return NotFound: it was carried out, cancelled, or never there
  void cancel(ScheduledId id, std::function<void(Status)> done);
  /// What waits in a scene, in the order it will be carried out.
  void list_scheduled(std::string scene, std::function<void(Result<std::vector<Scheduled>>)> done);
  /// Whether anybody wants to be told of markers. Nobody, at first: passing them costs nothing then.
  void set_audience(bool listens);
  void post(Task task);

  // On the strand:

  void plan(const EditOptions& options, const EditPlan& plan, const EditDone& done);
  /// As of a reading that is not before any other that was acted on.
  void carry_out(const std::string& scene, const PlayersChange& change, ClockUs as_of_us, const PlayersDone& done);
  /// Lets happen what happens by itself up to a reading, however late the strand is: nothing will act as of an earlier one.
  void advance(ClockUs now_us);

  /// The strand, for timers of those who work on it (streams).
  [[nodiscard]] boost::asio::io_context& strand() noexcept { return io_; }

 private:
  /// What an edit replaces and a failed commit brings back.
  struct State {
    model::ScenePtr scene;
    History undo;
    History redo;
  };
  struct Document {
    State head;
    SceneViewPtr published;  ///< null until the scene's creation is durable
    State durable;
    bool removed = false;  ///< the head: removed, not yet durable
  };
  /// An edit on its way to the disk.
  struct Pending {
    std::string scene;
    State after;  ///< scene is null: removed
    EditEvent event;
    std::string retry_key;
    std::string answer;
    EditDone done;
    std::vector<LayerFadeRequest> layer_fades;
    std::uint64_t epoch = 0;
  };
  struct Waiting {
    Scheduled what;
    TimedAct act;
  };
  struct RetryBook {
    std::unordered_map<std::string, std::string> answers;
    std::deque<std::string> order;
  };

  // stage_edits.cpp
  [[nodiscard]] Result<Document*> find_head(const EditOptions& options);
  [[nodiscard]] bool answered_before(const EditOptions& options, const EditDone& done);
  void submit(const EditOptions& options, Document& document, State after, EditSubject subject, std::string answer,
              EditDone done, std::vector<LayerFadeRequest> layer_fades = {});
  void commit_later(Pending pending);
  void remember_retry(const std::string& scene, const std::string& key, const std::string& answer);
  void forget_retry(const std::string& scene, const std::string& key);
  void committed(const store::CommitQueue::Group& group);
  void group_failed(std::vector<Pending> lost, const Error& error);
  void drop_heads();
  void group_succeeded(std::vector<Pending> done);
  void publish_head_map();

  // stage_players.cpp
  [[nodiscard]] std::shared_ptr<const Players> players_for(const model::Scene& next, const SceneViewPtr& before, ClockUs now_us,
                                                           const std::vector<LayerFadeRequest>& layer_fades);
  void publish(const std::string& scene, SceneViewPtr view);

  // stage_time.cpp
  void settle(ClockUs now_us);
  void settle_scene(const std::string& scene, const SceneViewPtr& before, ClockUs now_us);
  void tell_starts(const SceneViewPtr& before, const SceneViewPtr& after, ClockUs now_us);
  void tell_passed(const std::string& scene, std::vector<MarkerCrossed> crossed, ClockUs now_us);
  void arm_timer();
  [[nodiscard]] std::optional<ClockUs> next_event_us() const;

  // stage_schedule.cpp
  void run_due(ClockUs now_us);
  void forget_scheduled(const std::string& scene);

  using HeadMap = std::map<std::string, model::ScenePtr, std::less<>>;

  const Limits limits_;
  Metrics& metrics_;
  store::DocumentStore& store_;
  StageListener* listener_ = nullptr;
  Published<StageView> view_{std::make_shared<const StageView>()};
  Published<HeadMap> heads_{std::make_shared<const HeadMap>()};

  // The strand's own:
  std::map<std::string, Document> documents_;
  std::unordered_map<std::string, RetryBook> retries_;
  std::unordered_map<std::uint64_t, Pending> pending_;
  std::uint64_t next_ticket_ = 1;
  std::uint64_t epoch_ = 1;
  std::uint64_t next_serial_ = 1;
  std::map<std::pair<ClockUs, ScheduledId>, Waiting> scheduled_;  ///< of one reading, the one that came first is first
  ScheduledId next_scheduled_ = 1;
  bool audience_ = false;
  ClockUs settled_us_ = 0;      ///< what happens by itself has happened up to here
  ClockUs last_passed_us_ = 0;  ///< when markers were told last
  bool said_cut_ = false;

  boost::asio::io_context io_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{io_.get_executor()};
  boost::asio::steady_timer timer_{io_};
  std::unique_ptr<store::CommitQueue> queue_;
  std::thread thread_;
};

}  // namespace tweend::stage
