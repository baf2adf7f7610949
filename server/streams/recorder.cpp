#include "server/streams/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace tweend::streams {
namespace {

/// How often a recording that grows learns what is known by now, and looks whether there is more to draw.
constexpr std::chrono::milliseconds kTick{50};

}  // namespace

Recorder::Recorder(stage::Stage& stage, WorkerPool& workers, render::RenderThread& renderer, const Limits& limits,
                   Metrics& metrics)
    : stage_(stage), workers_(workers), renderer_(renderer), limits_(limits), metrics_(metrics), timer_(stage.strand()) {}

std::size_t Recorder::under_way() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(recordings_.begin(), recordings_.end(), [](const auto& entry) { return !entry.second.made; }));
}

Result<stage::SceneViewPtr> Recorder::find_scene(const std::string& name) const {
  if (finishing_) return fail(ErrorCode::Unavailable, "the server stops");
  if (stage::SceneViewPtr view = stage_.view()->find(name)) return view;
  return fail(ErrorCode::NotFound, fmt::format("expected a scene, found none called \"{}\"", name), "params.scene");
}

Error Recorder::too_many() const {
  std::string ids;
  for (const auto& [id, recording] : recordings_) {
    if (!recording.made) ids += fmt::format("{}{}", ids.empty() ? "" : ", ", id);
  }
  return fail(ErrorCode::Limit,
              fmt::format("expected at most {} recordings at once, found as many ({}); stop one with record.stop",
                          limits_.recordings, ids));
}

Result<RecordingId> Recorder::reserve(RecordingRequest request) {
  TWEEND_TRY(find_scene(request.scene));
  if (under_way() >= limits_.recordings) return too_many();
  for (const auto& [id, other] : recordings_) {
    if (!other.made && other.request.name == request.name) {
      return fail(ErrorCode::Conflict,
                  fmt::format("expected a name that nothing has, found that recording {} makes \"{}\"; choose another", id,
                              request.name),
                  "params.name");
    }
  }
  recordings_[++last_id_].request = std::move(request);
  return last_id_;
}

Result<RecordingStarted> Recorder::start(RecordingId id, std::unique_ptr<PictureSink> sink) {
  Recording& recording = recordings_.at(id);
  const RecordingRequest& request = recording.request;
  const Result<stage::SceneViewPtr> view = find_scene(request.scene);
  if (!view) {
    // It ends an encoder and removes files: that would hold up the strand.
    workers_.post([sink = std::shared_ptr<PictureSink>(std::move(sink))]() mutable { sink.reset(); });
    release(id);
    return view.error();
  }
  recording.start_us = steady_now_us();
  recording.views = std::make_shared<RecordedViews>(*view, recording.start_us, request.fps, limits_.recorded_pictures);
  recording.maker = std::make_shared<FilmMaker>(
      FilmMaker::Parts{recording.views, std::move(sink), request.size, request.camera}, workers_, renderer_,
      [this, id](const Result<Film>& film) { stage_.post([this, id, film] { made(id, film); }); });
  add(metrics_.recordings);
  {
    const std::lock_guard lock(mutex_);
    ++making_;
  }
  const RecordingStarted started{id, recording.start_us};
  if (!std::exchange(ticking_, true)) tick();
  return started;
}

void Recorder::stop(RecordingId id, Done done) {
  const auto at = recordings_.find(id);
  if (at == recordings_.end() || !(at->second.maker || at->second.made)) {
    return done(fail(ErrorCode::NotFound,
                     fmt::format("expected a recording, found none with the id {}; record.list names them", id),
                     "params.record"));
  }
  Recording& recording = at->second;
  if (recording.made) {
    const Result<Recorded> result = std::move(*recording.made);
    recordings_.erase(at);
    return done(result);
  }
  recording.stopped.push_back(std::move(done));
  if (recording.ending) return;
  const ClockUs last_us = steady_now_us();
  stage_.advance(last_us);  // what happened by itself up to then is to be seen, though the strand may be late
  end(recording, last_us);
}

void Recorder::end(Recording& recording, ClockUs last_us) {
  recording.ending = true;
  recording.views->end(last_us);
  recording.maker->go_on();
}

std::vector<RecordingNow> Recorder::list() const {
  std::vector<RecordingNow> list;
  for (const auto& [id, r] : recordings_) {
    RecordingNow now{id, r.request.scene, r.request.name, r.request.fps, 0, r.start_us, RecordingState::Running};
    if (r.maker) {
      now.pictures = r.maker->pictures();
      if (r.ending) now.state = RecordingState::Ending;
    } else if (!r.made) {
      continue;  // it has not begun
    } else {
      now.state = *r.made ? RecordingState::Done : RecordingState::Failed;
      if (*r.made) now.pictures = (*r.made)->pictures;
    }
    list.push_back(std::move(now));
  }
  return list;
}

void Recorder::follow(const std::string& scene, const stage::SceneViewPtr& view) {
  for (auto& [id, recording] : recordings_) {
    if (!recording.maker || recording.request.scene != scene) continue;
    if (!view) {
      end(recording, steady_now_us());
    } else if (!recording.views->add(view, steady_now_us())) {
      recording.ending = true;
      recording.views->give_up();
      recording.maker->give_up(
          fail(ErrorCode::Limit,
               fmt::format("expected at most {} changes of \"{}\" that wait for their pictures, found more; record "
                           "smaller pictures, or fewer a second",
                           RecordedViews::kMostKept, scene)));
    }
  }
}

void Recorder::made(RecordingId id, const Result<Film>& film) {
  const auto at = recordings_.find(id);
  Recording& recording = at->second;
  recording.maker.reset();
  recording.views.reset();
  Result<Recorded> result = Error{};
  if (film) {
    result = Recorded{recording.request.name, film->pictures, film->bytes};
  } else {
    result = film.error();
  }
  add(metrics_.recordings, -1);
  const std::vector<Done> stopped = std::move(recording.stopped);
  if (stopped.empty()) {
    recording.made = std::move(result);
    forget_first();
  } else {
    recordings_.erase(at);
    for (const Done& done : stopped) done(result);
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
  const ClockUs now_us = steady_now_us();
  stage_.advance(now_us);
  for (auto& [id, recording] : recordings_) {
    if (!recording.maker) continue;
    recording.views->settled(now_us);
    recording.maker->go_on();
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
