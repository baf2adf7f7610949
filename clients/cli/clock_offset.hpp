#pragma once

#include <cstdint>

namespace tweend::cli {

class Session;

/// How the server's steady clock stands to ours, as NTP estimates it.
struct ClockOffset {
  std::int64_t server_us = 0;      ///< what the server's clock said
  std::int64_t round_trip_us = 0;  ///< of the quickest question: the offset is off by half of this at most
  std::int64_t offset_us = 0;      ///< server minus ours
};

/// Asks so many times (at least once) and takes the quickest answer. Throws Refusal or NoServer.
[[nodiscard]] ClockOffset measure_clock(Session& session, std::uint64_t times);

}  // namespace tweend::cli
