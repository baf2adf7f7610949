#include "bench/support/seeking_viewer.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <span>

#include "bench/support/loopback.hpp"
#include "bench/support/server_process.hpp"
#include "bench/support/server_requests.hpp"

namespace tweend::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kPatienceSeconds = 5.0;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

SeekingViewer::SeekingViewer(std::uint16_t port, const std::string& params) : socket_(connect_loopback(port)) {
  send(request("stream.open", params));
  receive_until([this] { return all_answered() && packets_ > 0; });
}

SeekingViewer::~SeekingViewer() { ::close(socket_); }

void SeekingViewer::send(const std::string& line) {
  if (::send(socket_, line.data(), line.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(line.size())) {
    give_up("the server did not take a request");
  }
  ++asked_;
}

bool SeekingViewer::receive_some(double seconds) {
  pollfd ready{socket_, POLLIN, 0};
  if (::poll(&ready, 1, static_cast<int>(std::ceil(std::max(0.0, seconds) * 1e3))) == 0) return false;
  std::array<char, 65'536> chunk;
  const ssize_t got = ::recv(socket_, chunk.data(), chunk.size(), 0);
  if (got <= 0) give_up("the server closed a viewer's connection");
  received_.append(chunk.data(), static_cast<std::size_t>(got));
  return true;
}

bool SeekingViewer::take() {
  const std::string_view text = std::string_view(received_).substr(taken_);
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return false;
  const std::string_view line = text.substr(0, end);
  if (!line.starts_with(kAnnouncement)) {
    if (line.find("\"result\":") == std::string_view::npos) give_up("expected an answer, found " + std::string(line));
    ++answered_;
    taken_ += end + 1;
    return true;
  }
  const std::size_t bytes = announced_bytes(line);
  if (text.size() < end + 1 + bytes) return false;
  const std::string_view packet = text.substr(end + 1, bytes);
  const auto head = std::as_bytes(std::span(packet)).first<protocol::kPacketHeaderBytes>();
  const auto header = protocol::decode_header(head);
  if (!header) give_up(header.error().message);
  header_ = *header;
  payload_ = packet.substr(protocol::kPacketHeaderBytes);
  ++packets_;
  taken_ += end + 1 + bytes;
  return true;
}

template <class Done>
void SeekingViewer::receive_until(Done done) {
  const auto start = Clock::now();
  for (;;) {
    while (take()) {
      if (done()) return;
    }
    received_.erase(0, taken_);
    taken_ = 0;
    if (!receive_some(kPatienceSeconds) || seconds_since(start) > kPatienceSeconds) {
      give_up(fmt::format("what was waited for did not come within {} s", kPatienceSeconds));
    }
  }
}

void SeekingViewer::rest(double seconds) {
  const auto start = Clock::now();
  for (double left = seconds; left > 0.0; left = seconds - seconds_since(start)) {
    if (!receive_some(left)) return;
    while (take()) continue;
  }
}

double SeekingViewer::ping_ms() {
  const auto start = Clock::now();
  send(request("server.ping", "{}"));
  receive_until([this] { return all_answered(); });
  return 1e3 * seconds_since(start);
}

double SeekingViewer::seek_ms(double time_s, const Shows& shows) {
  const auto start = Clock::now();
  double took_ms = 0.0;
  std::size_t seen = packets_;
  send(request("playback.seek", fmt::format(R"({{"time":{}}})", time_s)));
  receive_until([&] {
    if (took_ms == 0.0 && packets_ != seen && shows(header_)) took_ms = 1e3 * seconds_since(start);
    seen = packets_;
    return took_ms > 0.0 && all_answered();
  });
  return took_ms;
}

}  // namespace tweend::bench
