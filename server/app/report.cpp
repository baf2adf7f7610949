#include "server/app/report.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>

namespace tweend::app {

Report::Report(std::size_t total) : total_(total) {
  winsize window{};
  if (::isatty(STDERR_FILENO) != 0)
    bar_.emplace(::ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0 ? window.ws_col : 80);
}

Report::~Report() {
  if (bar_) std::cerr << bar_->clear() << std::flush;
}

void Report::done(std::size_t count) {
  if (!bar_) return;
  const ClockUs now_us = steady_now_us();
  const double elapsed_s = static_cast<double>(now_us - start_us_) * 1e-6;
  std::cerr << bar_->draw({count, total_, elapsed_s, static_cast<double>(count) / std::max(elapsed_s, 1e-3), "fps"}, now_us)
            << std::flush;
}

}  // namespace tweend::app
