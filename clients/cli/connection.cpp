#include "clients/cli/connection.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>

#include "clients/cli/failure.hpp"
#include "clients/cli/format.hpp"

namespace tweend::cli {
namespace {

// No honest server announces more: the largest actor's vertices take 96 MB.
constexpr std::size_t kLargestPacket = std::size_t{1} << 30U;

Json parse_message(const std::string& line) {
  Json message = Json::parse(line, nullptr, false);
  if (!message.is_object()) throw NoServer(fmt::format("what answers is no tweend server: it says '{:.60}'", printable(line)));
  return message;
}

bool is_notification(const Json& message, std::string_view method) {
  const auto found = message.find("method");
  return found != message.end() && found->is_string() && found->get_ref<const std::string&>() == method;
}

Refusal refusal(std::string_view method, const Json& error) {
  const Json data = error.value("data", Json::object());
  const auto text = [&](const char* member) { return data.is_object() ? printable(data.value(member, std::string())) : ""; };
  std::string what = text("kind");
  if (what.empty()) what = fmt::format("{}", error.value("code", 0));
  if (const auto path = text("path"); !path.empty()) what += ", " + path;
  std::string message = text("message");
  if (message.empty()) message = printable(error.value("message", std::string("no reason given")));
  return {fmt::format("{} refused ({}): {}", method, what, message), to_line(error)};
}

/// An answer without an id is one to a request that the server could not read: as we have only one underway, it is ours.
bool answers(const Json& message, std::int64_t id) {
  if (message.contains("method")) return false;
  const auto found = message.find("id");
  return found == message.end() || found->is_null() || *found == id;
}

}  // namespace

Json Connection::call(std::string_view method, const Json& params, Deadline deadline) {
  const std::int64_t id = ++last_id_;
  try {
    socket_.send(to_line({{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}}) + "\n", deadline);
    for (;;) {
      Message message = read(deadline);
      if (message.packet) {
        kept_.push_back(std::move(message));
        continue;
      }
      Json json = parse_message(message.line);
      if (!answers(json, id)) {
        kept_.push_back(std::move(message));
        continue;
      }
      if (const auto error = json.find("error"); error != json.end()) throw refusal(method, *error);
      return std::move(json.at("result"));
    }
  } catch (const TimedOut& timeout) {
    throw NoServer(fmt::format("no answer to {} in time: {}", method, timeout.what()));
  } catch (const NoServer& lost) {
    throw NoServer(fmt::format("no answer to {}: {}", method, lost.what()));
  }
}

Message Connection::next(Deadline deadline) {
  if (kept_.empty()) return read(deadline);
  Message message = std::move(kept_.front());
  kept_.pop_front();
  return message;
}

Message Connection::read(Deadline deadline) {
  buffer_.erase(0, taken_);
  taken_ = 0;
  try {
    std::string line = read_line(deadline);
    // Only announcements are worth parsing here, and an answer may be large.
    if (line.size() < 1024 && line.find("stream.packet") != std::string::npos) {
      if (const Json message = parse_message(line); is_notification(message, "stream.packet")) {
        return {{}, read_packet(message.at("params"), deadline)};
      }
    }
    return {std::move(line), {}};
  } catch (const TimedOut&) {
    taken_ = 0;  // so that the announcement is read again with its packet
    throw;
  }
}

std::string Connection::read_line(Deadline deadline) {
  std::size_t end = 0;
  for (std::size_t size = 0; (end = buffer_.find('\n', taken_ + size)) == std::string::npos;) {
    size = buffer_.size() - taken_;
    need(size + 1, deadline);
  }
  std::string line = take(end + 1 - taken_);
  line.pop_back();
  if (line.ends_with('\r')) line.pop_back();
  return line;
}

Packet Connection::read_packet(const Json& announcement, Deadline deadline) {
  const auto size = announcement.at("bytes").get<std::size_t>();
  if (size < protocol::kPacketHeaderBytes || size > kLargestPacket) {
    throw NoServer(fmt::format("the server announced a packet of {} bytes", size));
  }
  need(size, deadline);
  Packet packet;
  packet.payload = take(size);
  const auto bytes = std::as_bytes(std::span(packet.payload)).first<protocol::kPacketHeaderBytes>();
  auto header = protocol::decode_header(bytes);
  if (!header) throw NoServer("a broken packet: " + header.error().message);
  if (header->payload_bytes != size - protocol::kPacketHeaderBytes) {
    throw NoServer(fmt::format("a broken packet: {} bytes, but its header says {}", size - protocol::kPacketHeaderBytes,
                               header->payload_bytes));
  }
  packet.header = *header;
  packet.payload.erase(0, protocol::kPacketHeaderBytes);
  return packet;
}

void Connection::need(std::size_t size, Deadline deadline) {
  while (buffer_.size() - taken_ < size) {
    if (!socket_.read_some(buffer_, deadline)) throw NoServer("the connection was closed");
  }
}

std::string Connection::take(std::size_t size) {
  std::string taken = buffer_.substr(taken_, size);
  taken_ += size;
  return taken;
}

}  // namespace tweend::cli
