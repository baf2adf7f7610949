#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "server/base/clock.hpp"

namespace tweend::cli {

/// What a stream brought so far. Takes the time from outside.
class StreamTally {
 public:
  /// A packet came.
  /// @param age_us  between the clock reading it shows and its arrival
  void add(std::uint32_t sequence, std::size_t bytes, ClockUs age_us, ClockUs now_us);

  [[nodiscard]] std::uint64_t packets() const noexcept { return packets_; }
  [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }
  /// Packets that the server made and did not send us: gaps in the sequence.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }
  /// Packets a second between the first and the last; 0: not known yet.
  [[nodiscard]] double rate() const noexcept;
  [[nodiscard]] ClockUs last_age_us() const noexcept { return last_age_us_; }
  /// Of the last 65,536 packets, so that watching for days takes no more memory; 0 where none came.
  [[nodiscard]] ClockUs median_age_us() const;

 private:
  std::uint64_t packets_ = 0;
  std::uint64_t bytes_ = 0;
  std::uint64_t skipped_ = 0;
  std::optional<std::uint32_t> last_sequence_;
  ClockUs first_us_ = 0;
  ClockUs last_us_ = 0;
  ClockUs last_age_us_ = 0;
  std::vector<ClockUs> ages_us_;  ///< a ring once it is full
};

}  // namespace tweend::cli
