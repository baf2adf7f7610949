#include "clients/cli/stream_tally.hpp"

#include <algorithm>

namespace tweend::cli {
namespace {

constexpr std::size_t kAges = 65536;

/// How many numbers lie between; 0 where the sequence went back, as it does when the server starts it anew.
std::uint32_t gap(std::uint32_t before, std::uint32_t sequence) {
  constexpr std::uint32_t kHalf = 1U << 31U;  // the counter wraps, so that less than half of its way is forward
  const std::uint32_t step = sequence - before;
  return step == 0 || step >= kHalf ? 0 : step - 1;
}

}  // namespace

void StreamTally::add(std::uint32_t sequence, std::size_t bytes, ClockUs age_us, ClockUs now_us) {
  if (last_sequence_) skipped_ += gap(*last_sequence_, sequence);
  last_sequence_ = sequence;
  if (packets_ == 0) first_us_ = now_us;
  last_us_ = now_us;
  last_age_us_ = age_us;
  bytes_ += bytes;
  if (ages_us_.size() < kAges) {
    ages_us_.push_back(age_us);
  } else {
    ages_us_[packets_ % kAges] = age_us;
  }
  ++packets_;
}

double StreamTally::rate() const noexcept {
  if (packets_ < 2 || last_us_ <= first_us_) return 0.0;
  return static_cast<double>(packets_ - 1) / seconds_between(first_us_, last_us_);
}

ClockUs StreamTally::median_age_us() const {
  if (ages_us_.empty()) return 0;
  std::vector<ClockUs> ages = ages_us_;
  const auto middle = ages.begin() + static_cast<std::ptrdiff_t>(ages.size() / 2);
  std::nth_element(ages.begin(), middle, ages.end());
  return *middle;
}

}  // namespace tweend::cli
