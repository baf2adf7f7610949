#pragma once

#include <cstddef>
#include <optional>

#include "server/base/clock.hpp"
#include "server/base/progress_bar.hpp"

namespace tweend::app {

/// How far a job is, on a terminal; nothing where standard error is none. One thread at a time.
class Report {
 public:
  explicit Report(std::size_t total);
  ~Report();
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;

  void done(std::size_t count);

 private:
  const std::size_t total_;
  const ClockUs start_us_ = steady_now_us();
  std::optional<ProgressBar> bar_;
};

}  // namespace tweend::app
