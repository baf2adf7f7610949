#include "server/streams/still_queue.hpp"

#include <fmt/format.h>

namespace tweend::streams {

Status StillQueue::render(StillRequest request, StillDone done) {
  {
    const std::lock_guard lock(mutex_);
    if (under_way_ == at_once_) {
      if (waiting_.size() >= kWaiting) {
        return fail(ErrorCode::Unavailable,
                    fmt::format("expected at most {} pictures to be waited for, found as many; ask again later", kWaiting));
      }
      waiting_.emplace_back(std::move(request), std::move(done));
      return {};
    }
    ++under_way_;
  }
  begin(std::move(request), std::move(done));
  return {};
}

void StillQueue::begin(StillRequest request, StillDone done) {
  render_still(std::move(request), workers_, renderer_, [this, done = std::move(done)](Result<Still> still) {
    done(std::move(still));
    ended();
  });
}

void StillQueue::ended() {
  std::pair<StillRequest, StillDone> next;
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.empty()) {
      --under_way_;
      return;
    }
    next = std::move(waiting_.front());
    waiting_.pop_front();
  }
  begin(std::move(next.first), std::move(next.second));
}

}  // namespace tweend::streams
