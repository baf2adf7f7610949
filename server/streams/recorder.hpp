#pragma once

#include <boost/asio/steady_timer.hpp>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/base/clock.hpp"
#include "server/base/limits.hpp"
#include "server/base/metrics.hpp"
#include "server/stage/stage.hpp"
#include "server/streams/film.hpp"
#include "server/streams/recorded_views.hpp"

namespace tweend::streams {

using RecordingId = std::int64_t;

struct RecordingRequest {
  std::string scene;
  std::string name;  ///< of the file that the sink makes: no two at once
  double fps = 30.0;
  render::Size size;
  std::optional<model::CameraRequest> camera;  ///< empty: the scene's
};

struct RecordingStarted {
  RecordingId id = 0;
  ClockUs start_us = 0;  ///< what the first picture shows
};

struct Recorded {
  std::string name;
  std::size_t pictures = 0;
  std::uint64_t bytes = 0;
};

enum class RecordingState : std::uint8_t {
  Running,
  Ending,  ///< its last pictures are made
  Done,    ///< by itself: nobody has asked what it came to yet
  Failed,  ///< the same
};

struct RecordingNow {
  RecordingId id = 0;
  std::string scene, name;
  double fps = 0.0;
  std::size_t pictures = 0;  ///< that are in the file
  ClockUs start_us = 0;
  RecordingState state = RecordingState::Running;
};

/// Recordings: picture k shows the scene at the reading start + k / fps, and whatever the machine's speed, none is missed. A
/// recording keeps the published views and works through its pictures at its own pace; when it is stopped, those up to then are
/// made yet. It ends by itself where its scene is removed, after so many pictures as Limits allow, or on an error (one is that
/// more changes wait for their pictures than are kept); what came of it is kept until it is asked for.
///
/// Functions run on the stage's strand (post to it) unless they say otherwise.
class Recorder {
 public:
  /// How many that have ended by themselves are remembered; of more, the first is forgotten.
  static constexpr std::size_t kRemembered = 1'000;
  using Done = std::function<void(Result<Recorded>)>;

  Recorder(stage::Stage& stage, WorkerPool& workers, render::RenderThread& renderer, const Limits& limits, Metrics& metrics);

  /// Takes one of the places and the name for a recording whose sink is still to be made: start() or release() follows.
  /// @return NotFound without such a scene, Limit where too many are under way, Conflict where one of them has this name
  [[nodiscard]] Result<RecordingId> reserve(RecordingRequest request);
  /// From this moment on, in a place that was reserved. The sink of one that is refused goes on a worker, and the place with
  /// it.
  /// @return NotFound where the scene has gone meanwhile, Unavailable where the server stops
  [[nodiscard]] Result<RecordingStarted> start(RecordingId id, std::unique_ptr<PictureSink> sink);
  /// Gives a place back: there is no sink for it.
  void release(RecordingId id) { recordings_.erase(id); }
  /// No picture after this moment. Whoever stops one that is ending is told with the first.
  /// @param done  once the file is whole, or with what went wrong; NotFound at once
  void stop(RecordingId id, Done done);
  /// Those that run, are ending, or have ended by themselves and not been stopped yet, in the order they began.
  [[nodiscard]] std::vector<RecordingNow> list() const;
  /// The stage has published a view (null: the scene is gone).
  void follow(const std::string& scene, const stage::SceneViewPtr& view);

  /// Ends all with what has been drawn, and returns when their files are whole. Not on the strand, which has to run; once.
  void finish_all();

 private:
  struct Recording {
    RecordingRequest request;
    ClockUs start_us = 0;
    std::shared_ptr<RecordedViews> views;
    std::shared_ptr<FilmMaker> maker;  ///< null before it starts, and once the film is made
    std::optional<Result<Recorded>> made;
    bool ending = false;
    std::vector<Done> stopped;  ///< who wait for it
  };
  using Recordings = std::map<RecordingId, Recording>;
  [[nodiscard]] Result<stage::SceneViewPtr> find_scene(const std::string& name) const;
  [[nodiscard]] Error too_many() const;
  static void end(Recording& recording, ClockUs last_us);
  void made(RecordingId id, const Result<Film>& film);
  void tick();
  [[nodiscard]] std::size_t under_way() const noexcept;
  void forget_first();

  stage::Stage& stage_;
  WorkerPool& workers_;
  render::RenderThread& renderer_;
  const Limits& limits_;
  Metrics& metrics_;
  boost::asio::steady_timer timer_;
  Recordings recordings_;
  RecordingId last_id_ = 0;
  bool ticking_ = false;
  bool finishing_ = false;

  std::mutex mutex_;
  std::condition_variable idle_;
  std::size_t making_ = 0;  ///< films that are under way, or have not been told of
  bool told_ = false;       ///< all to finish
};

}  // namespace tweend::streams
