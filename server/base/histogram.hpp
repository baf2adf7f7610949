#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace tweend {

/// How often a duration was how long, in buckets that are the same for all of them. Any thread may observe or read.
class Histogram {
 public:
  /// Upper bounds of the buckets, microseconds; what is above the last one is counted, too.
  static constexpr std::array<std::int64_t, 14> kBoundsUs{50,     100,    250,    500,     1'000,   2'500,   5'000,
                                                          10'000, 25'000, 50'000, 100'000, 250'000, 500'000, 1'000'000};

  /// @param us  microseconds, not negative
  void observe(std::int64_t us) noexcept;

  struct Reading {
    std::array<std::int64_t, kBoundsUs.size()> up_to{};  ///< so many were not above each bound
    std::int64_t count = 0;
    std::int64_t sum_us = 0;
  };
  [[nodiscard]] Reading read() const noexcept;

 private:
  std::array<std::atomic<std::int64_t>, kBoundsUs.size() + 1> buckets_{};
  std::atomic<std::int64_t> sum_us_{0};
};

}  // namespace tweend
