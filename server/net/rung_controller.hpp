#pragma once

#include <cstddef>
#include <cstdint>

namespace tweend::net {

/// Chooses the rung of one adaptive stream (streams/rungs.hpp) for one reader, from what becomes of its packets.
///
/// A packet is pressed where a newer one took its place before it was written, or where writing it took long. Three of sixteen
/// send the stream one rung down, but a rung is judged only from when its own first packet has been written: what a larger rung
/// has left on the way is not held against it. After a while of calm, in which sixteen packets were not pressed, the rung above
/// is tried; where that fails, the next try waits twice as long, up to a minute, and a try that holds makes the wait shorter
/// again.
///
/// Pure: no clock of its own; `now_us` only grows. One thread.
class RungController {
 public:
  static constexpr std::int64_t kCalmUs = 2'000'000;  ///< before the rung above is tried, at first
  static constexpr std::int64_t kLongestCalmUs = 60'000'000;
  static constexpr std::int64_t kProbationUs = 5'000'000;  ///< a try that is pressed sooner has failed
  static constexpr std::int64_t kLongWaitUs = 250'000;     ///< from being offered to being written
  static constexpr std::int64_t kPatienceUs = 5'000'000;   ///< for the first packet of a rung that was chosen
  static constexpr int kJudgedPackets = 16;
  static constexpr int kPressedPackets = 3;

  /// @param rungs  how many there are, at least 1; the first, 0, is where it starts
  explicit RungController(std::size_t rungs) noexcept : lowest_(rungs - 1) {}

  /// Where the stream is to be.
  [[nodiscard]] std::size_t rung() const noexcept { return rung_; }

  /// From here on packets are those of the rung that was chosen last.
  void settle() noexcept;
  /// A packet was written to the last byte, so long after it was offered.
  void written(std::int64_t now_us, std::int64_t waited_us) noexcept;
  /// A newer packet took the place of one that waited.
  void replaced(std::int64_t now_us) noexcept;

 private:
  enum class Phase : std::uint8_t {
    Chosen,   ///< packets of the rung before still come
    Settled,  ///< its packets come, none has been written yet
    Judged,
  };
  void judge(std::int64_t now_us, bool pressed) noexcept;
  void begin_judging(std::int64_t now_us) noexcept;
  void choose(std::int64_t now_us, std::size_t rung) noexcept;

  const std::size_t lowest_;
  std::size_t rung_ = 0;
  Phase phase_ = Phase::Settled;
  std::uint32_t history_ = 0;  ///< of the packets judged last, a bit each: whether it was pressed
  bool probing_ = false;       ///< the rung was reached from below and has not held for long enough yet
  std::int64_t chosen_us_ = 0;
  std::int64_t judged_since_us_ = 0;
  std::int64_t calm_since_us_ = 0;
  std::int64_t calm_us_ = kCalmUs;
  int calm_packets_ = 0;  ///< not pressed since then
};

}  // namespace tweend::net
