#include "server/net/rung_controller.hpp"

#include <algorithm>
#include <bit>

namespace tweend::net {

void RungController::settle() noexcept {
  if (phase_ == Phase::Chosen) phase_ = Phase::Settled;
}

void RungController::written(std::int64_t now_us, std::int64_t waited_us) noexcept {
  if (phase_ == Phase::Settled) return begin_judging(now_us);  // it may have waited for what was larger
  judge(now_us, waited_us > kLongWaitUs);
}

void RungController::replaced(std::int64_t now_us) noexcept { judge(now_us, true); }

void RungController::begin_judging(std::int64_t now_us) noexcept {
  phase_ = Phase::Judged;
  history_ = 0;
  judged_since_us_ = now_us;
  calm_since_us_ = now_us;
  calm_packets_ = 0;
}

void RungController::judge(std::int64_t now_us, bool pressed) noexcept {
  if (phase_ != Phase::Judged) {
    // Whoever was to send the new rung's packets does not; what comes instead is judged after all.
    if (phase_ == Phase::Chosen && now_us - chosen_us_ > kPatienceUs) begin_judging(now_us);
    return;
  }
  constexpr std::uint32_t kJudged = (1U << kJudgedPackets) - 1U;
  history_ = ((history_ << 1U) | (pressed ? 1U : 0U)) & kJudged;
  const int pressed_packets = std::popcount(history_);
  if (!pressed) {
    calm_packets_ = std::min(calm_packets_ + 1, kJudgedPackets);
  } else if (pressed_packets > 1) {  // one alone may be anything
    calm_since_us_ = now_us;
    calm_packets_ = 0;
  }
  if (pressed_packets >= kPressedPackets) {
    if (probing_) calm_us_ = std::min(2 * calm_us_, kLongestCalmUs);
    probing_ = false;
    history_ = 0;
    if (rung_ < lowest_) choose(now_us, rung_ + 1);
    return;
  }
  if (probing_ && now_us - judged_since_us_ >= kProbationUs) {
    probing_ = false;
    calm_us_ = std::max(calm_us_ / 4, kCalmUs);
  }
  const bool calm = calm_packets_ == kJudgedPackets;  // time in which nothing was sent says nothing
  if (!pressed && calm && rung_ > 0 && now_us - calm_since_us_ >= calm_us_) {
    choose(now_us, rung_ - 1);
    probing_ = true;
  }
}

void RungController::choose(std::int64_t now_us, std::size_t rung) noexcept {
  rung_ = rung;
  chosen_us_ = now_us;
  phase_ = Phase::Chosen;
}

}  // namespace tweend::net
