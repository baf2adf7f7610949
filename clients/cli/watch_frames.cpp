#include "clients/cli/watch_frames.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "clients/cli/arguments.hpp"
#include "clients/cli/failure.hpp"
#include "clients/cli/frame_lines.hpp"
#include "clients/cli/frame_recording.hpp"
#include "clients/cli/frame_store.hpp"
#include "clients/cli/interrupt.hpp"
#include "clients/cli/packet_stream.hpp"
#include "clients/cli/picture_options.hpp"
#include "clients/cli/session.hpp"
#include "server/base/clock.hpp"

namespace tweend::cli {
namespace {

// How long an interrupt waits for a packet, and the progress bar for its next second.
constexpr double kTickS = 0.1;

std::optional<Packet> next_within(PacketStream& stream, double seconds) {
  try {
    return stream.next(deadline_in(seconds));
  } catch (const TimedOut&) {
    return std::nullopt;
  }
}

/// @return false: it was interrupted
bool record(PacketStream& stream, FrameRecording& recording) {
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

ExitCode store_frames(Session& session, PacketStream& stream, FrameStore& store, const std::string& out, std::uint64_t count) {
  FrameRecording recording(session, store, stream.layout(), out, count);
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

/// Before anything is asked of the server. @return nullptr: nothing is stored. Throws Usage.
std::unique_ptr<FrameStore> open_store(Session& session, const std::string& out, const std::string& encoding) {
  if (out.empty()) return nullptr;
  const bool is_folder = encoding == "jpeg" || encoding == "png";
  if (out.ends_with(".mp4")) {
    throw Usage(fmt::format("--out: expected a {}, found {}; `tweenctl record start` makes films",
                            is_folder ? "folder with " + encoding : "name such as film." + encoding, out));
  }
  if (is_folder) {
    if (out != "-") return std::make_unique<PictureFolder>(out);
    throw Usage("--out: expected a folder with " + encoding + ", found -; h264 and rgba can be written to standard output");
  }
  if (out == "-") {
    if (session.options().json) {
      throw Usage("--out: expected a file with --json, whose lines go to standard output, found -");
    }
    session.expect_no_terminal(encoding);
  }
  return std::make_unique<PayloadFile>(out, session.out());
}

}  // namespace

ExitCode watch_frames(Session& session, const Arguments& arguments) {
  Json params{{"kind", "frames"}, {"encoding", "jpeg"}};
  params.update(picture_params(arguments));
  const auto out = arguments.get<std::string>("out", "");
  const auto store = open_store(session, out, params.at("encoding").get<std::string>());
  PacketStream stream(session, params);
  if (store) return store_frames(session, stream, *store, out, arguments.get<std::uint64_t>("count", 0));
  return print_packets(session, stream, arguments, [&](const Packet& packet, ClockUs age_us) {
    return session.options().json ? frame_json(packet, age_us, "") : frame_text(packet, age_us, stream.layout());
  });
}

}  // namespace tweend::cli
