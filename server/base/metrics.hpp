#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tweend {

/// The server's counters and gauges, one member per row of metrics.def. Any thread may change or read them.
struct Metrics {
  using Value = std::atomic<std::int64_t>;
#define TWEEND_METRIC(name, type, help) Value name{0};
#include "server/base/metrics.def"
#undef TWEEND_METRIC

  struct Reading {
    std::string_view name;  ///< without the tweend_ prefix
    std::string_view type;  ///< "counter" or "gauge"
    std::string_view help;
    std::int64_t value;
  };
  [[nodiscard]] std::vector<Reading> read() const;

  /// Prometheus text exposition format 0.0.4, names `tweend_…`.
  [[nodiscard]] std::string prometheus_text() const;
};

inline void add(Metrics::Value& value, std::int64_t n = 1) noexcept { value.fetch_add(n, std::memory_order_relaxed); }

}  // namespace tweend
