#include "clients/cli/frame_recording.hpp"

#include <fmt/format.h>

#include <ostream>

#include "clients/cli/format.hpp"
#include "clients/cli/frame_lines.hpp"

namespace tweend::cli {
namespace {

double milliseconds(ClockUs us) { return static_cast<double>(us) * 1e-3; }

}  // namespace

bool FrameRecording::store(const Packet& packet, ClockUs age_us, ClockUs now_us) {
  const std::string file = store_.store(packet);
  tally_.add(packet.header.sequence, packet.payload.size(), age_us, now_us);
  last_size_ = frame_size_text(packet, layout_);
  return !session_.options().json || session_.print_line(frame_json(packet, age_us, file));
}

void FrameRecording::show(ClockUs now_us) {
  if (!shows_bar()) return;
  const std::string note =
      fmt::format("{}, {} skipped, age {:.1f} ms", last_size_, tally_.skipped(), milliseconds(tally_.last_age_us()));
  Progress progress;
  progress.done = tally_.packets();
  if (count_ > 0) progress.total = count_;
  progress.elapsed_s = seconds_between(begun_us_, now_us);
  progress.rate = tally_.rate();
  progress.unit = "fps";
  if (tally_.packets() > 0) progress.note = note;
  session_.err() << bar_.draw(progress, now_us) << std::flush;
}

void FrameRecording::sum_up() {
  session_.err() << bar_.clear() << std::flush;
  if (session_.options().json) return;  // a program has had a line for each
  const std::string rate = tally_.rate() > 0.0 ? fmt::format("{:.1f} fps", tally_.rate()) : "- fps";
  const std::string sum = fmt::format("{}: {} {}, {}, {} skipped, median age {:.1f} ms, {}", printable(out_), tally_.packets(),
                                      tally_.packets() == 1 ? "frame" : "frames", rate, tally_.skipped(),
                                      milliseconds(tally_.median_age_us()), bytes_text(tally_.bytes()));
  if (out_ == "-") {
    session_.err() << sum << '\n';
  } else {
    (void)session_.print_line(sum);
  }
}

}  // namespace tweend::cli
