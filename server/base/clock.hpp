#pragma once

#include <chrono>
#include <cstdint>

namespace tweend {

/// A reading of the server's steady clock in microseconds: what `server.ping` tells and packets carry.
using ClockUs = std::int64_t;

using SteadyClock = std::chrono::steady_clock;

[[nodiscard]] inline ClockUs steady_now_us() noexcept {
  return std::chrono::duration_cast<std::chrono::microseconds>(SteadyClock::now().time_since_epoch()).count();
}

/// The instant of a reading, for timers.
[[nodiscard]] inline SteadyClock::time_point instant(ClockUs at_us) noexcept {
  return SteadyClock::time_point(std::chrono::microseconds(at_us));
}

/// Seconds between two readings, correctly rounded: 400,000 us are 0.4.
[[nodiscard]] constexpr double seconds_between(ClockUs from_us, ClockUs to_us) noexcept {
  return static_cast<double>(to_us - from_us) / 1e6;
}

}  // namespace tweend
