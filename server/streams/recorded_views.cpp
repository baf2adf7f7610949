#include "server/streams/recorded_views.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tweend::streams {

ClockUs holds_from_us(const stage::SceneView& before, const stage::SceneView& next, ClockUs now_us) noexcept {
  if (before.scene != next.scene) return now_us;
  ClockUs from_us = std::numeric_limits<ClockUs>::min();
  for (std::size_t i = 0; i < next.players->size(); ++i) {
    const stage::Player& was = (*before.players)[i];
    const stage::Player& is = (*next.players)[i];
    // A turn sets the anchor to its reading; what leaves the anchor alone (a live pose) counts from now.
    if (!(was == is)) from_us = std::max(from_us, was.anchor_us == is.anchor_us ? now_us : is.anchor_us);
  }
  return from_us == std::numeric_limits<ClockUs>::min() ? now_us : std::min(from_us, now_us);
}

RecordedViews::RecordedViews(stage::SceneViewPtr view, ClockUs start_us, double fps, std::size_t most)
    : start_us_(start_us), fps_(std::max(fps, kSlowestFilm)), most_(most) {
  stretches_.push_back({std::numeric_limits<ClockUs>::min(), std::move(view)});
}

ClockUs RecordedViews::reading(std::size_t picture) const noexcept {
  return start_us_ + std::llround(static_cast<double>(picture) * 1e6 / fps_);
}

bool RecordedViews::is_seen(ClockUs from_us, ClockUs to_us) const noexcept {
  if (reading(next_) >= to_us) return false;
  if (reading(next_) >= from_us) return true;
  // The first one at or after `from_us`, give or take the rounding.
  auto picture = static_cast<std::size_t>(std::floor(static_cast<double>(from_us - start_us_) * fps_ / 1e6));
  picture -= std::min<std::size_t>(picture, 1);
  while (reading(picture) < from_us) ++picture;
  return reading(picture) < to_us;
}

bool RecordedViews::add(const stage::SceneViewPtr& view, ClockUs now_us) {
  const std::lock_guard lock(mutex_);
  if (last_us_ || given_up_) return true;
  const Stretch& newest = stretches_.back();
  const ClockUs from_us = std::max(newest.from_us, holds_from_us(*newest.view, *view, now_us));
  if (!is_seen(newest.from_us, from_us)) {
    // It goes on from where the one before began: no picture looks there.
    stretches_.back().view = view;
    return true;
  }
  if (stretches_.size() == kMostKept) return false;
  stretches_.push_back({from_us, view});
  return true;
}

void RecordedViews::settled(ClockUs until_us) {
  const std::lock_guard lock(mutex_);
  settled_us_ = until_us;
}

void RecordedViews::end(ClockUs last_us) {
  const std::lock_guard lock(mutex_);
  if (!last_us_) last_us_ = last_us;
}

void RecordedViews::give_up() {
  const std::lock_guard lock(mutex_);
  given_up_ = true;
}

FilmSource::Next RecordedViews::next(stage::Show& out) {
  stage::SceneViewPtr view;
  ClockUs at_us = 0;
  {
    const std::lock_guard lock(mutex_);
    at_us = reading(next_);
    if (given_up_ || next_ == most_ || (last_us_ && at_us > *last_us_)) return Next::End;
    if (!last_us_ && at_us >= settled_us_) return Next::Later;
    while (stretches_.size() > 1 && stretches_[1].from_us <= at_us) stretches_.pop_front();
    view = stretches_.front().view;
    ++next_;
  }
  stage::show_at(*view, at_us, out);
  return Next::Picture;
}

std::size_t RecordedViews::kept() const {
  const std::lock_guard lock(mutex_);
  return stretches_.size();
}

}  // namespace tweend::streams
