#include "server/base/progress_bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tweend {
namespace {

constexpr ClockUs kRedrawUs = 100'000;
constexpr std::size_t kNarrowest = 10;  // inside the brackets; a shorter bar says nothing
constexpr std::size_t kWidest = 40;
constexpr std::string_view kGap = "  ";

double fraction(const Progress& progress, std::uint64_t total) {
  if (total == 0) return 1.0;
  return std::min(1.0, static_cast<double>(progress.done) / static_cast<double>(total));
}

std::string bar(double fraction, std::size_t inside) {
  const auto full = static_cast<std::size_t>(std::floor(fraction * static_cast<double>(inside)));
  std::string text = "[" + std::string(full, '=');
  if (full < inside) text += '>' + std::string(inside - full - 1, ' ');
  return text + "]";
}

std::string time_text(const Progress& progress) {
  if (!progress.total) return duration_text(progress.elapsed_s);
  const std::uint64_t left = *progress.total - std::min(progress.done, *progress.total);
  if (left == 0) return "ETA 0:00";
  return "ETA " + duration_text(progress.rate > 0.0 ? static_cast<double>(left) / progress.rate : -1.0);
}

/// Everything but the bar.
std::string figures(const Progress& progress, bool with_note) {
  std::string text = progress.total ? fmt::format("{}/{}", progress.done, *progress.total) : fmt::format("{}", progress.done);
  if (progress.rate > 0.0) text += fmt::format("{}{:.1f} {}", kGap, progress.rate, progress.unit);
  if (with_note && !progress.note.empty()) text += fmt::format("{}{}", kGap, progress.note);
  return fmt::format("{}{}{}", text, kGap, time_text(progress));
}

}  // namespace

std::string progress_line(const Progress& progress, std::size_t width) {
  std::string text = figures(progress, true);
  const std::size_t frame = 2 + kGap.size();  // the brackets, and what stands between the bar and the figures
  if (progress.total && text.size() + frame + kNarrowest <= width) {
    const std::size_t inside = std::min(kWidest, width - text.size() - frame);
    return fmt::format("{}{}{}", bar(fraction(progress, *progress.total), inside), kGap, text);
  }
  if (text.size() > width) text = figures(progress, false);
  return text.substr(0, width);
}

std::string duration_text(double seconds) {
  constexpr double kTooLong = 100.0 * 3600.0;
  if (!(seconds >= 0.0) || seconds >= kTooLong) return "-:--";
  const auto whole = static_cast<std::uint64_t>(std::llround(seconds));
  const std::uint64_t hours = whole / 3600;
  const std::uint64_t minutes = whole / 60 % 60;
  if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60);
  return fmt::format("{}:{:02}", minutes, whole % 60);
}

std::string ProgressBar::draw(const Progress& progress, ClockUs now_us) {
  if (drawn_us_ && now_us - *drawn_us_ < kRedrawUs) return {};
  drawn_us_ = now_us;
  // The last column stays free: some terminals go to the next line after writing there.
  const std::string line = progress_line(progress, std::max<std::size_t>(columns_, 1) - 1);
  // Spaces over what is left of a longer line, since not every terminal knows how to erase.
  const std::size_t rest = drawn_ - std::min(drawn_, line.size());
  drawn_ = line.size();
  return fmt::format("\r{}{:{}}", line, "", rest);
}

std::string ProgressBar::clear() {
  if (drawn_ == 0) return {};
  const std::size_t drawn = drawn_;
  drawn_ = 0;
  drawn_us_.reset();
  return fmt::format("\r{:{}}\r", "", drawn);
}

}  // namespace tweend
