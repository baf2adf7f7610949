#include "server/base/histogram.hpp"

#include <algorithm>

namespace tweend {

void Histogram::observe(std::int64_t us) noexcept {
  const auto bucket = std::lower_bound(kBoundsUs.begin(), kBoundsUs.end(), us) - kBoundsUs.begin();
  buckets_[static_cast<std::size_t>(bucket)].fetch_add(1, std::memory_order_relaxed);
  sum_us_.fetch_add(us, std::memory_order_relaxed);
}

Histogram::Reading Histogram::read() const noexcept {
  Reading reading;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    reading.count += buckets_[i].load(std::memory_order_relaxed);
    if (i < reading.up_to.size()) reading.up_to[i] = reading.count;
  }
  reading.sum_us = sum_us_.load(std::memory_order_relaxed);
  return reading;
}

}  // namespace tweend
