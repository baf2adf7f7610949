#include "bench/support/picture_viewer.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstring>

#include "bench/support/loopback.hpp"
#include "bench/support/server_process.hpp"

namespace tweend::bench {
namespace {

constexpr std::size_t kHeaderBytes = 40;
constexpr std::size_t kSequenceOffset = 12;

}  // namespace

PictureViewer::PictureViewer(std::uint16_t port, const std::string& params) : socket_(connect_loopback(port)) {
  const std::string line = R"({"jsonrpc":"2.0","id":1,"method":"stream.open","params":)" + params + "}\n";
  if (::send(socket_, line.data(), line.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(line.size())) give_up("nothing was sent");
  while (!open_) {
    pollfd ready{socket_, POLLIN, 0};
    if (::poll(&ready, 1, 5000) <= 0) give_up("stream.open was not answered within 5 s");
    drain();
  }
}

PictureViewer::~PictureViewer() { ::close(socket_); }

void PictureViewer::drain() {
  char chunk[262'144];
  ssize_t got = 0;
  while ((got = ::recv(socket_, chunk, sizeof chunk, MSG_DONTWAIT)) > 0) {
    received_.append(chunk, static_cast<std::size_t>(got));
    std::size_t taken = 0;
    while (const std::size_t whole = take(std::string_view(received_).substr(taken))) taken += whole;
    received_.erase(0, taken);
  }
  if (got == 0) give_up("the server closed a viewer's connection");
}

std::size_t PictureViewer::take(std::string_view text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return 0;
  const std::string_view line = text.substr(0, end);
  if (!line.starts_with(kAnnouncement)) {
    if (line.find("\"stream\":") == std::string_view::npos) give_up("stream.open was answered by " + std::string(line));
    open_ = true;
    return end + 1;
  }
  const std::size_t bytes = announced_bytes(line);
  if (text.size() < end + 1 + bytes) return 0;
  take_packet(text.substr(end + 1, bytes));
  return end + 1 + bytes;
}

void PictureViewer::take_packet(std::string_view packet) {
  ++pictures_;
  if (!keeping_) return;
  std::uint32_t sequence = 0;
  std::memcpy(&sequence, packet.data() + kSequenceOffset, sizeof sequence);  // little-endian, as we are
  kept_[sequence] = packet.substr(kHeaderBytes);
}

void watch(const Viewers& viewers, double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  std::vector<pollfd> sockets;
  for (const auto& viewer : viewers) sockets.push_back({viewer->socket(), POLLIN, 0});
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) return;
    if (::poll(sockets.data(), sockets.size(), static_cast<int>(left)) <= 0) continue;
    for (std::size_t i = 0; i < sockets.size(); ++i) {
      if (sockets[i].revents != 0) viewers[i]->drain();
    }
  }
}

}  // namespace tweend::bench
