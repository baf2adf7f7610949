#include "clients/cli/packet_stream.hpp"

#include <fmt/format.h>

#include <utility>

#include "clients/cli/arguments.hpp"
#include "clients/cli/clock_offset.hpp"
#include "clients/cli/event.hpp"
#include "clients/cli/failure.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/session.hpp"

namespace tweend::cli {
namespace {

Json flag_words(std::uint8_t flags) {
  Json words = Json::array();
  if (flags & protocol::kFlagKey) words.push_back("key");
  if (flags & protocol::kFlagDiscontinuity) words.push_back("discontinuity");
  if (flags & protocol::kFlagLast) words.push_back("last");
  return words;
}

}  // namespace

PacketStream::PacketStream(Session& session, const Json& params)
    : session_(session), offset_us_(measure_clock(session, 4).offset_us) {
  Json opened = session.call("stream.open", params);
  stream_ = std::move(opened.at("stream"));
  layout_ = opened.value("layout", Json::object());
}

Packet PacketStream::next(Deadline deadline) {
  for (;;) {
    Message message = session_.next(deadline);
    if (message.packet) return std::move(*message.packet);
    check_ended(message.line);
  }
}

ClockUs PacketStream::age_us(const Packet& packet, ClockUs now_us) const noexcept {
  return now_us + offset_us_ - packet.header.server_us;
}

void PacketStream::check_ended(const std::string& line) const {
  const Json event = parse_event(line);
  if (event.at("method") != "stream.ended" || event.at("params").value("stream", Json()) != stream_) return;
  throw Failure(ExitCode::Refused, "the stream has ended: " + brief_member(event.at("params"), "reason"));
}

ExitCode print_packets(const Session& session, PacketStream& stream, const Arguments& arguments,
                       const std::function<std::string(const Packet& packet, ClockUs age_us)>& line) {
  const auto count = arguments.get<std::uint64_t>("count", 0);
  for (std::uint64_t seen = 0; count == 0 || seen < count; ++seen) {
    const Packet packet = stream.next({});
    if (!session.print_line(line(packet, stream.age_us(packet, steady_now_us())))) break;
  }
  return ExitCode::Done;
}

std::string packet_text(const Packet& packet, ClockUs age_us) {
  const auto& header = packet.header;
  return fmt::format("#{:<6} {:>9.3f} s  age {:>6.1f} ms  {:<18}", header.sequence, static_cast<double>(header.media_us) * 1e-6,
                     static_cast<double>(age_us) * 1e-3, brief(flag_words(header.flags)));
}

Json packet_json(const Packet& packet, ClockUs age_us) {
  const auto& header = packet.header;
  return {{"stream", header.stream},
          {"sequence", header.sequence},
          {"media_us", header.media_us},
          {"server_us", header.server_us},
          {"age_us", age_us},
          {"revision", header.revision},
          {"flags", flag_words(header.flags)}};
}

}  // namespace tweend::cli
