#include "clients/cli/watch_frames.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>

#include "clients/cli/arguments.hpp"
#include "clients/cli/failure.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/interrupt.hpp"
#include "clients/cli/packet_stream.hpp"
#include "clients/cli/picture.hpp"
#include "clients/cli/picture_options.hpp"
#include "clients/cli/session.hpp"
#include "clients/cli/stream_tally.hpp"
#include "clients/cli/write_file.hpp"
#include "server/base/clock.hpp"
#include "server/base/progress_bar.hpp"

namespace tweend::cli {
namespace {

// How long an interrupt waits for a packet, and the progress bar for its next second.
constexpr double kTickS = 0.1;

double milliseconds(ClockUs us) { return static_cast<double>(us) * 1e-3; }

PictureFormat picture_format(const Packet& packet) {
  const auto format = format_of_packet(packet.header.encoding);
  if (packet.header.kind != protocol::PacketKind::Frame || !format) {
    throw NoServer(fmt::format("packet {}: expected a frame in jpeg or png, found kind {} in encoding {}",
                               packet.header.sequence, static_cast<int>(packet.header.kind), packet.header.encoding));
  }
  return *format;
}

/// @param file  where the picture was stored; empty: nowhere
std::string frame_json(const Packet& packet, ClockUs age_us, const std::string& file) {
  Json json = packet_json(packet, age_us);
  json["encoding"] = name_of(picture_format(packet));
  json["bytes"] = packet.header.payload_bytes;
  if (!file.empty()) json["file"] = file;
  return to_line(json);
}

std::string frame_text(const Packet& packet, ClockUs age_us, const Json& layout) {
  return fmt::format("{}  {} {} x {}, {}", packet_text(packet, age_us), name_of(picture_format(packet)),
                     brief_member(layout, "width"), brief_member(layout, "height"), bytes_text(packet.payload.size()));
}

ExitCode print_frames(Session& session, PacketStream& stream, std::uint64_t count) {
  for (std::uint64_t seen = 0; count == 0 || seen < count; ++seen) {
    const Packet packet = stream.next({});
    const ClockUs age_us = stream.age_us(packet, steady_now_us());
    const bool json = session.options().json;
    if (!session.print_line(json ? frame_json(packet, age_us, "") : frame_text(packet, age_us, stream.layout()))) break;
  }
  return ExitCode::Done;
}

/// Stores pictures in a folder, and says how it goes: a progress bar for who sits there, lines for programs.
class Recording {
 public:
  /// @param count  how many there will be; 0: nobody knows
  Recording(Session& session, std::string folder, std::uint64_t count)
      : session_(session), folder_(std::move(folder)), count_(count), bar_(session.err_columns()) {}

  [[nodiscard]] bool is_complete() const noexcept { return count_ > 0 && tally_.packets() >= count_; }
  /// @return false once nobody reads the lines any more. Throws Failure.
  [[nodiscard]] bool store(const Packet& packet, ClockUs age_us, ClockUs now_us);
  void show(ClockUs now_us);
  void sum_up();

 private:
  [[nodiscard]] bool shows_bar() const { return session_.err_columns() > 0 && !session_.options().json; }

  Session& session_;
  std::string folder_;
  std::uint64_t count_;
  ClockUs begun_us_ = steady_now_us();
  StreamTally tally_;
  ProgressBar bar_;
};

bool Recording::store(const Packet& packet, ClockUs age_us, ClockUs now_us) {
  const PictureFormat format = picture_format(packet);
  check_picture(packet.payload, format, fmt::format("packet {}", packet.header.sequence));
  const std::string name = fmt::format("frame_{:06}{}", packet.header.sequence, extension_of(format));
  const std::string file = (std::filesystem::path(folder_) / name).string();
  write_file(file, packet.payload);
  tally_.add(packet.header.sequence, packet.payload.size(), age_us, now_us);
  return !session_.options().json || session_.print_line(frame_json(packet, age_us, file));
}

void Recording::show(ClockUs now_us) {
  if (!shows_bar()) return;
  const std::string age = fmt::format("age {:.1f} ms", milliseconds(tally_.last_age_us()));
  Progress progress;
  progress.done = tally_.packets();
  if (count_ > 0) progress.total = count_;
  progress.elapsed_s = seconds_between(begun_us_, now_us);
  progress.rate = tally_.rate();
  progress.unit = "fps";
  if (tally_.packets() > 0) progress.note = age;
  session_.err() << bar_.draw(progress, now_us) << std::flush;
}

void Recording::sum_up() {
  session_.err() << bar_.clear() << std::flush;
  if (session_.options().json) return;  // a program has had a line for each
  const std::string rate = tally_.rate() > 0.0 ? fmt::format("{:.1f} fps", tally_.rate()) : "- fps";
  (void)session_.print_line(fmt::format("{}: {} {}, {}, {} skipped, median age {:.1f} ms, {}", printable(folder_),
                                        tally_.packets(), tally_.packets() == 1 ? "frame" : "frames", rate, tally_.skipped(),
                                        milliseconds(tally_.median_age_us()), bytes_text(tally_.bytes())));
}

std::optional<Packet> next_within(PacketStream& stream, double seconds) {
  try {
    return stream.next(deadline_in(seconds));
  } catch (const TimedOut&) {
    return std::nullopt;
  }
}

/// @return false: it was interrupted
bool record(PacketStream& stream, Recording& recording) {
  const Interrupt interrupt;
  recording.show(steady_now_us());
  while (!recording.is_complete()) {
    if (interrupt.came()) return false;
    const auto packet = next_within(stream, kTickS);
    const ClockUs now_us = steady_now_us();
    if (packet && !recording.store(*packet, stream.age_us(*packet, now_us), now_us)) return true;
    recording.show(now_us);
  }
  return true;
}

ExitCode store_frames(Session& session, PacketStream& stream, const std::string& folder, std::uint64_t count) {
  Recording recording(session, folder, count);
  bool is_done = false;
  try {
    is_done = record(stream, recording);
  } catch (const Failure&) {
    recording.sum_up();  // what was stored is there
    throw;
  }
  recording.sum_up();
  return is_done ? ExitCode::Done : ExitCode::Interrupted;
}

}  // namespace

ExitCode watch_frames(Session& session, const Arguments& arguments) {
  const auto folder = arguments.get<std::string>("folder", "");
  if (!folder.empty()) make_folder(folder);
  Json params{{"kind", "frames"}, {"encoding", "jpeg"}};
  params.update(picture_params(arguments));
  PacketStream stream(session, params);
  const auto count = arguments.get<std::uint64_t>("count", 0);
  return folder.empty() ? print_frames(session, stream, count) : store_frames(session, stream, folder, count);
}

}  // namespace tweend::cli
