#include "bench/support/loopback.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <string>

#include "bench/support/server_process.hpp"
#include "protocol/packet.hpp"

namespace tweend::bench {

int connect_loopback(std::uint16_t port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) give_up(std::strerror(errno));
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return socket;
}

std::size_t announced_bytes(std::string_view line) {
  constexpr std::string_view kKey = "\"bytes\":";
  const std::size_t at = line.find(kKey);
  std::size_t bytes = 0;
  if (at != std::string_view::npos) std::from_chars(line.data() + at + kKey.size(), line.data() + line.size(), bytes);
  if (bytes < protocol::kPacketHeaderBytes) give_up("no packet was announced by " + std::string(line));
  return bytes;
}

}  // namespace tweend::bench
