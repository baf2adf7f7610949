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

#include "server/base/clock.hpp"
#include "server/base/limits.hpp"
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
  std::unique_ptr<PictureSink> sink;
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

/// Recordings: picture k shows the scene at the reading start + k / fps, and whatever the machine's speed, none is missed. A
/// recording keeps the published views and works through its pictures at its own pace; when it is stopped, those up to then are
/// made yet. It ends by itself where its scene is removed, after so many pictures as Limits allow, or on an error; what came of
/// it is kept until it is asked for.
///
/// Functions run on the stage's strand (post to it) unless they say otherwise.
class Recorder {
 public:
  /// How many that have ended by themselves are remembered; of more, the first is forgotten.
  static constexpr std::size_t kRemembered = 1'000;
  using Done = std::function<void(Result<Recorded>)>;

  Recorder(stage::Stage& stage, WorkerPool& workers, render::RenderThread& renderer, const Limits& limits);

  /// Whether it could start now; its sink is not looked at, and need not be made yet.
  /// @return NotFound without such a scene, Limit where too many are under way, Conflict where one of them has this name
  [[nodiscard]] Status may_start(const RecordingRequest& request) const;
  /// From this moment on. The sink of one that is refused goes on a worker.
  /// @return as may_start()
  [[nodiscard]] Result<RecordingStarted> start(RecordingRequest request);
  /// No picture after this moment.
  /// @param done  once the file is whole, or with what went wrong; NotFound at once
  void stop(RecordingId id, Done done);
  /// The stage has published a view (null: the scene is gone).
  void follow(const std::string& scene, const stage::SceneViewPtr& view);

  /// Ends all with what has been drawn, and returns when their files are whole. Not on the strand, which has to run; once.
  void finish_all();

 private:
  struct Recording {
    std::string scene, name;
    std::shared_ptr<RecordedViews> views;
    std::shared_ptr<FilmMaker> maker;  ///< null once the film is made
    std::optional<Result<Recorded>> made;
    Done stopped;  ///< who waits for it
  };
  using Recordings = std::map<RecordingId, Recording>;
  void made(RecordingId id, const Result<Film>& film);
  void tick();
  [[nodiscard]] std::size_t under_way() const noexcept;
  void forget_first();

  stage::Stage& stage_;
  WorkerPool& workers_;
  render::RenderThread& renderer_;
  const Limits& limits_;
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
