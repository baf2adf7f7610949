#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "server/stage/stage.hpp"

// Commands that wait for their reading of the clock. However late the timer is, each is carried out as of its reading, after
// all that happened by itself up to there and before anything later.

namespace tweend::stage {
namespace {

Error no_such_scene(const std::string& scene) {
  return fail(ErrorCode::NotFound, fmt::format("expected the name of a scene, found \"{}\"; scene.list names them", scene),
              "params.scene");
}

}  // namespace

void Stage::schedule(std::string scene, std::string method, Timing timing, TimedAct act, ScheduledAnswer answer,
                     EditDone done) {
  post([this, scene = std::move(scene), method = std::move(method), timing, act = std::move(act), answer = std::move(answer),
        done = std::move(done)] {
    const ClockUs now_us = steady_now_us();
    advance(now_us);
    if (timing.at_us <= now_us) {
      if (timing.late_is_error) {
        return done(fail(ErrorCode::InvalidParams,
                         fmt::format("expected a reading of the clock that is to come, found {}, which was {} us ago",
                                     timing.at_us, now_us - timing.at_us),
                         "params.at_us"));
      }
      return act(now_us, done);
    }
    const auto document = documents_.find(scene);
    if (document == documents_.end() || document->second.removed) return done(no_such_scene(scene));
    if (scheduled_.size() >= limits_.scheduled_commands) {
      return done(fail(ErrorCode::Limit, fmt::format("expected at most {} scheduled commands, found as many waiting; "
                                                     "schedule.cancel takes one back",
                                                     limits_.scheduled_commands)));
    }
    const ScheduledId id = next_scheduled_++;
    scheduled_.emplace(std::pair(timing.at_us, id), Waiting{{id, timing.at_us, method, scene}, act});
    done(answer(id, timing.at_us));
    arm_timer();
  });
}

void Stage::run_due(ClockUs now_us) {
  while (!scheduled_.empty() && scheduled_.begin()->first.first <= now_us) {
    const Waiting due = std::move(scheduled_.extract(scheduled_.begin()).mapped());
    settle(due.what.at_us);
    due.act(due.what.at_us, [this, what = due.what](const Result<std::string>& answer) {
      if (!answer) listener_->schedule_failed(what, answer.error());
    });
  }
}

void Stage::cancel(ScheduledId id, std::function<void(Status)> done) {
  post([this, id, done = std::move(done)] {
    advance(steady_now_us());
    const auto erased = std::erase_if(scheduled_, [id](const auto& entry) { return entry.second.what.id == id; });
    arm_timer();
    if (erased == 0) {
      return done(fail(ErrorCode::NotFound,
                       fmt::format("expected a command that waits, found {}; schedule.list names them", id),
                       "params.scheduled"));
    }
    done({});
  });
}

void Stage::list_scheduled(std::string scene, std::function<void(Result<std::vector<Scheduled>>)> done) {
  post([this, scene = std::move(scene), done = std::move(done)] {
    const auto document = documents_.find(scene);
    if (document == documents_.end() || !document->second.published) return done(no_such_scene(scene));
    std::vector<Scheduled> list;
    for (const auto& [key, waiting] : scheduled_) {
      if (waiting.what.scene == scene) list.push_back(waiting.what);
    }
    done(std::move(list));
  });
}

void Stage::forget_scheduled(const std::string& scene) {
  std::erase_if(scheduled_, [&scene](const auto& entry) { return entry.second.what.scene == scene; });
}

}  // namespace tweend::stage
