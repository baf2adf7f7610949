#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "server/base/log.hpp"
#include "server/stage/course.hpp"
#include "server/stage/stage.hpp"

// What happens by itself as the clock runs: queues move on, players end, markers are passed, scheduled commands come due. All
// of it follows from the published players, so that it is worked out whenever something is about to change, and by one timer
// that is set for the next time something will.

namespace tweend::stage {
namespace {

/// Markers are told this often at most: those of a sixtieth of a second together.
constexpr ClockUs kTickUs = 16'667;

bool passes_markers(const model::Actor& actor) {
  return std::any_of(actor.clips.begin(), actor.clips.end(), [](const model::ClipPtr& c) { return c->markers != nullptr; });
}

void append(std::vector<MarkerCrossed>& to, const std::string& actor, const std::vector<Passed>& passed) {
  for (const Passed& p : passed) to.push_back({actor, p.clip->name, (*p.clip->markers)[p.marker], p.at_us});
}

}  // namespace

void Stage::advance(ClockUs now_us) {
  run_due(now_us);
  settle(now_us);
}

void Stage::settle(ClockUs now_us) {
  now_us = std::max(now_us, settled_us_);
  for (auto& [name, document] : documents_) {
    if (document.published) settle_scene(name, document.published, now_us);
  }
  settled_us_ = now_us;
}

void Stage::settle_scene(const std::string& scene, const SceneViewPtr& before, ClockUs now_us) {
  std::vector<MarkerCrossed> crossed;
  std::vector<std::size_t> moved;
  std::vector<std::pair<ClockUs, std::size_t>> ended;
  std::shared_ptr<Players> players;
  for (std::size_t i = 0; i < before->players->size(); ++i) {
    const Player& player = (*before->players)[i];
    if (!player.playing) continue;
    const model::Actor& actor = *before->scene->actors[i];
    const auto end = player.end_us(player.range_of(*clip_of(actor, player)));
    const bool marks = audience_ && passes_markers(actor);
    if (!marks && !(end && *end <= now_us)) continue;
    Course course = run_player(actor, player, settled_us_, now_us, marks ? kMostCrossings : 0);
    append(crossed, actor.name, course.passed);
    if (course.cut && !std::exchange(said_cut_, true)) {
      log::warn(fmt::format("the actor \"{}\" passes more than {} markers in a tick: the rest of them is not told", actor.name,
                            kMostCrossings));
    }
    if (!course.moved) continue;
    if (!players) players = std::make_shared<Players>(*before->players);
    (*players)[i] = std::move(course.player);
    moved.push_back(i);
    if (course.ended) ended.emplace_back(course.ended_us, i);
  }
  tell_passed(scene, std::move(crossed), now_us);
  if (!players) return;
  const auto view = std::make_shared<const SceneView>(SceneView{before->scene, std::move(players), next_serial_++});
  publish(scene, view);
  listener_->players_changed(view, moved, now_us);
  std::sort(ended.begin(), ended.end());  // of a scene, who ends first is told first, however late this comes
  for (const auto& [at_us, i] : ended) listener_->player_ended(view, i);
}

void Stage::tell_starts(const SceneViewPtr& before, const SceneViewPtr& after, ClockUs now_us) {
  if (!audience_) return;
  std::vector<MarkerCrossed> crossed;
  for (std::size_t i = 0; i < after->players->size(); ++i) {
    const Player& player = (*after->players)[i];
    if (player.starts == (*before->players)[i].starts || !player.playing) continue;
    append(crossed, player.actor, markers_at_start(*after->scene->actors[i], player));
  }
  tell_passed(after->scene->name, std::move(crossed), now_us);
}

void Stage::tell_passed(const std::string& scene, std::vector<MarkerCrossed> crossed, ClockUs now_us) {
  if (crossed.empty()) return;
  last_passed_us_ = now_us;
  std::stable_sort(crossed.begin(), crossed.end(),
                   [](const MarkerCrossed& a, const MarkerCrossed& b) { return a.at_us < b.at_us; });
  listener_->markers_crossed(scene, crossed);
}

void Stage::set_audience(bool listens) {
  post([this, listens] {
    advance(steady_now_us());  // what was before is told to those of then
    audience_ = listens;
    arm_timer();
  });
}

std::optional<ClockUs> Stage::next_event_us() const {
  std::optional<ClockUs> first;
  const auto take = [&first](std::optional<ClockUs> at) {
    if (at && (!first || *at < *first)) first = at;
  };
  if (!scheduled_.empty()) take(scheduled_.begin()->first.first);
  for (const auto& [name, document] : documents_) {
    if (!document.published) continue;
    const SceneView& view = *document.published;
    for (std::size_t i = 0; i < view.players->size(); ++i) {
      const Player& player = (*view.players)[i];
      if (!player.playing) continue;
      const model::Actor& actor = *view.scene->actors[i];
      take(player.end_us(player.range_of(*clip_of(actor, player))));
      if (!audience_) continue;
      if (const auto passed = next_marker_us(actor, player, settled_us_)) take(std::max(*passed, last_passed_us_ + kTickUs));
    }
  }
  return first;
}

void Stage::arm_timer() {
  const auto next = next_event_us();
  if (!next) {
    timer_.cancel();
    return;
  }
  timer_.expires_at(instant(*next));
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (error) return;  // armed anew
    advance(steady_now_us());
    arm_timer();
  });
}

}  // namespace tweend::stage
