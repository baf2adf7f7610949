#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "clients/cli/frame_store.hpp"
#include "clients/cli/packet_stream.hpp"
#include "clients/cli/session.hpp"
#include "clients/cli/stream_tally.hpp"
#include "server/base/clock.hpp"
#include "server/base/progress_bar.hpp"

namespace tweend::cli {

/// Stores what a stream of frames sends, and says how it goes: a progress bar for who sits there, lines for programs. Sums up
/// at the end.
class FrameRecording {
 public:
  /// @param out    where the store lies; `-`: standard output, which is then nobody else's
  /// @param count  how many there will be; 0: nobody knows
  FrameRecording(Session& session, FrameStore& store, const Json& layout, std::string out, std::uint64_t count)
      : session_(session), store_(store), layout_(layout), out_(std::move(out)), count_(count), bar_(session.err_columns()) {}

  [[nodiscard]] bool is_complete() const noexcept { return count_ > 0 && tally_.packets() >= count_; }
  /// @return false once nobody reads the lines any more. Throws Failure.
  [[nodiscard]] bool store(const Packet& packet, ClockUs age_us, ClockUs now_us);
  void show(ClockUs now_us);
  void sum_up();

 private:
  [[nodiscard]] bool shows_bar() const { return session_.err_columns() > 0 && !session_.options().json; }

  Session& session_;
  FrameStore& store_;
  const Json& layout_;
  std::string out_;
  std::uint64_t count_;
  ClockUs begun_us_ = steady_now_us();
  StreamTally tally_;
  std::string last_size_;
  ProgressBar bar_;
};

}  // namespace tweend::cli
