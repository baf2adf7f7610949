#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/base/clock.hpp"

namespace tweend {

/// How far a long piece of work has come.
struct Progress {
  std::uint64_t done = 0;
  std::optional<std::uint64_t> total;  ///< empty: nobody knows; 0: there was nothing to do
  double elapsed_s = 0.0;
  double rate = 0.0;           ///< so many done a second; 0: not known yet
  std::string_view unit = {};  ///< of the rate, `fps`
  std::string_view note = {};  ///< anything else worth a few columns, `age 3.1 ms`; one column a byte
};

/// One line of at most `width` columns, ASCII, without a line end: `[=====>   ]  12/20  29.9 fps  age 3.1 ms  ETA 0:04`.
/// Where the total is unknown there is no bar, and the time that has passed instead of the time that is left.
/// What does not fit goes: first the bar, then the note, then the end of the line.
[[nodiscard]] std::string progress_line(const Progress& progress, std::size_t width);

/// Seconds as `m:ss` or `h:mm:ss`; `-:--` for what is no time or too long to be one.
[[nodiscard]] std::string duration_text(double seconds);

/// A line of a terminal that is drawn over and over. Says what to write there, and never writes itself. Used by one thread.
class ProgressBar {
 public:
  /// @param columns  of the terminal
  explicit ProgressBar(std::size_t columns) : columns_(columns) {}

  /// What to write now; empty if the line was drawn less than a tenth of a second ago.
  [[nodiscard]] std::string draw(const Progress& progress, ClockUs now_us);
  /// What removes the line; empty if there is none.
  [[nodiscard]] std::string clear();

 private:
  std::size_t columns_;
  std::size_t drawn_ = 0;  ///< columns that hold something
  std::optional<ClockUs> drawn_us_;
};

}  // namespace tweend
