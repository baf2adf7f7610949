#include "server/streams/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace tweend::streams {
namespace {

/// How often a recording that grows looks whether there is more to draw.
constexpr std::chrono::milliseconds kTick{50};

}  // namespace

Recorder::Recorder(stage::Stage& stage, WorkerPool& workers, render::RenderThread& renderer, const Limits& limits)
    : stage_(stage), workers_(workers), renderer_(renderer), limits_(limits), timer_(stage.strand()) {}

std::size_t Recorder::under_way() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(recordings_.begin(), recordings_.end(), [](const auto& entry) { return entry.second.maker != nullptr; }));
}

Status Recorder::may_start(const RecordingRequest& request) const {
  if (finishing_) return fail(ErrorCode::Unavailable, "the server stops");
  if (!stage_.view()->find(request.scene)) {
    return fail(ErrorCode::NotFound, fmt::format("expected a scene, found none called \"{}\"", request.scene), "params.scene");
  }
  if (const std::size_t most = limits_.recordings; under_way() >= most) {
    return fail(ErrorCode::Limit,
                fmt::format("expected at most {} recordings at once, found as many; stop one with record.stop", most));
  }
  for (const auto& [id, other] : recordings_) {
    if (other.maker && other.name == request.name) {
      return fail(ErrorCode::Conflict,
                  fmt::format("expected a name that nothing has, found that recording {} makes \"{}\"; choose another", id,
                              request.name),
                  "params.name");
    }
  }
  return {};
}

Result<RecordingStarted> Recorder::start(RecordingRequest request) {
  if (const Status may = may_start(request); !may) {
    // It ends an encoder and removes files: that would hold up the strand.
    workers_.post([sink = std::shared_ptr<PictureSink>(std::move(request.sink))]() mutable { sink.reset(); });
    return may.error();
  }
  const RecordingStarted started{++last_id_, steady_now_us()};
  const auto views = std::make_shared<RecordedViews>(stage_.view()->find(request.scene), started.start_us, request.fps,
                                                     limits_.recorded_pictures);
  auto maker = std::make_shared<FilmMaker>(
      FilmMaker::Parts{views, std::move(request.sink), request.size, request.camera}, workers_, renderer_,
      [this, id = started.id](const Result<Film>& film) { stage_.post([this, id, film] { made(id, film); }); });
  {
    const std::lock_guard lock(mutex_);
    ++making_;
  }
  Recording& recording = recordings_[started.id];
  recording.scene = std::move(request.scene);
  recording.name = std::move(request.name);
  recording.views = views;
  recording.maker = std::move(maker);
  if (!std::exchange(ticking_, true)) tick();
  return started;
}

void Recorder::stop(RecordingId id, Done done) {
  const auto at = recordings_.find(id);
  if (at == recordings_.end()) {
    return done(fail(ErrorCode::NotFound, fmt::format("expected a recording, found none with the id {}", id), "params.record"));
  }
  Recording& recording = at->second;
  if (recording.made) {
    const Result<Recorded> result = std::move(*recording.made);
    recordings_.erase(at);
    return done(result);
  }
  if (recording.stopped) {
    return done(fail(ErrorCode::Conflict,
                     fmt::format("expected a recording that nobody has stopped, found that {} is ending", id),
                     "params.record"));
  }
  recording.stopped = std::move(done);
  recording.views->end(steady_now_us());
  recording.maker->go_on();
}

void Recorder::follow(const std::string& scene, const stage::SceneViewPtr& view) {
  for (auto& [id, recording] : recordings_) {
    if (!recording.maker || recording.scene != scene) continue;
    if (view) {
      recording.views->add(view, steady_now_us());
    } else {
      recording.views->end(steady_now_us());
      recording.maker->go_on();
    }
  }
}

void Recorder::made(RecordingId id, const Result<Film>& film) {
  const auto at = recordings_.find(id);
  Recording& recording = at->second;
  recording.maker.reset();
  Result<Recorded> result = Error{};
  if (film) {
    result = Recorded{recording.name, film->pictures, film->bytes};
  } else {
    result = film.error();
  }
  if (recording.stopped) {
    const Done stopped = std::move(recording.stopped);
    recordings_.erase(at);
    stopped(result);
  } else {
    recording.made = std::move(result);
    recording.views.reset();
    forget_first();
  }
  const std::lock_guard lock(mutex_);
  if (--making_ == 0) idle_.notify_all();
}

void Recorder::forget_first() {
  if (recordings_.size() - under_way() <= kRemembered) return;
  const auto first =
      std::find_if(recordings_.begin(), recordings_.end(), [](const auto& entry) { return entry.second.made.has_value(); });
  recordings_.erase(first);
}

void Recorder::tick() {
  if (finishing_ || under_way() == 0) {
    ticking_ = false;
    return;
  }
  for (auto& [id, recording] : recordings_) {
    if (recording.maker) recording.maker->go_on();
  }
  timer_.expires_after(kTick);
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (!error) tick();
  });
}

void Recorder::finish_all() {
  stage_.post([this] {
    finishing_ = true;
    timer_.cancel();
    for (auto& [id, recording] : recordings_) {
      if (!recording.maker) continue;
      recording.views->give_up();
      recording.maker->go_on();
    }
    const std::lock_guard lock(mutex_);
    told_ = true;
    idle_.notify_all();
  });
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [this] { return told_ && making_ == 0; });
}

}  // namespace tweend::streams
