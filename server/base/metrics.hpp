#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "server/base/histogram.hpp"

namespace tweend {

/// The server's counters, gauges and histograms, one member per row of metrics.def. Any thread may change or read them.
struct Metrics {
  using Value = std::atomic<std::int64_t>;
#define TWEEND_METRIC(name, type, help) Value name{0};
#define TWEEND_HISTOGRAM(name, help) Histogram name;
#include "server/base/metrics.def"
#undef TWEEND_HISTOGRAM
#undef TWEEND_METRIC

  struct Reading {
    std::string name;  ///< as in the text, `tweend_…`, with labels where there are some
    double value;
  };
  /// Every sample of the text.
  [[nodiscard]] std::vector<Reading> read() const;

  /// Prometheus text exposition format 0.0.4, names `tweend_…`; histograms in seconds.
  [[nodiscard]] std::string prometheus_text() const;
};

inline void add(Metrics::Value& value, std::int64_t n = 1) noexcept { value.fetch_add(n, std::memory_order_relaxed); }

}  // namespace tweend
