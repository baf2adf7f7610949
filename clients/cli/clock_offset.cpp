#include "clients/cli/clock_offset.hpp"

#include <nlohmann/json.hpp>

#include "clients/cli/session.hpp"
#include "server/base/clock.hpp"

namespace tweend::cli {

ClockOffset measure_clock(Session& session, std::uint64_t times) {
  ClockOffset best;
  for (std::uint64_t i = 0; i == 0 || i < times; ++i) {
    const ClockUs asked_us = steady_now_us();
    const auto server_us = session.call("server.ping", Json::object()).at("time_us").get<std::int64_t>();
    const ClockUs answered_us = steady_now_us();
    const std::int64_t round_trip_us = answered_us - asked_us;
    if (i == 0 || round_trip_us < best.round_trip_us) {
      best = {server_us, round_trip_us, server_us - (asked_us + round_trip_us / 2)};
    }
  }
  return best;
}

}  // namespace tweend::cli
