#include "clients/cli/socket.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

#include "clients/cli/failure.hpp"

namespace tweend::cli {

namespace net = boost::asio;
using boost::system::error_code;
using net::ip::tcp;

Deadline deadline_in(double seconds) {
  using Seconds = std::chrono::duration<double>;
  // Further away the clock's integer would overflow; a year is as good as for ever.
  constexpr double kYear = 365.0 * 86400.0;
  const Seconds wait{std::clamp(seconds, 0.0, kYear)};
  return std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(wait);
}

struct Socket::Asio {
  net::io_context io;
  tcp::resolver resolver{io};
  tcp::socket socket{io};

  /// Runs the one operation that was started; false if the deadline came first, and then the operation has been cancelled.
  bool finish(const Deadline& deadline) {
    io.restart();
    if (deadline) {
      io.run_until(*deadline);
      io.poll();  // who was kept from running past the deadline has not seen yet what came in time
    } else {
      io.run();
    }
    if (io.stopped()) return true;
    error_code ignored;
    resolver.cancel();
    socket.cancel(ignored);
    io.run();
    return false;
  }
};

Socket::Socket(const Endpoint& endpoint, Deadline deadline) : asio_(std::make_unique<Asio>()) {
  static const error_code kCancelled = net::error::operation_aborted;  // by the deadline: no further address is tried
  error_code error = kCancelled;
  error_code no_address;
  const auto address = net::ip::make_address(endpoint.host, no_address);
  // An unknown zone would be taken for 0: the resolver says what is wrong with it.
  const bool is_numeric = !no_address && endpoint.host.find('%') == std::string::npos;
  if (is_numeric) {  // needs no resolver's thread
    asio_->socket.async_connect({address, endpoint.port}, [&](error_code connect_error) { error = connect_error; });
  } else {
    asio_->resolver.async_resolve(
        endpoint.host, std::to_string(endpoint.port), [&](error_code resolve_error, const tcp::resolver::results_type& found) {
          error = resolve_error;
          if (error) return;
          net::async_connect(
              asio_->socket, found, [&](const error_code& before, const tcp::endpoint&) { return before != kCancelled; },
              [&](error_code connect_error, const tcp::endpoint&) { error = connect_error; });
        });
  }
  const bool in_time = asio_->finish(deadline);
  if (error) {
    throw NoServer(fmt::format("no server at {} ({}); is `tweend serve` running there?", to_string(endpoint),
                               in_time ? error.message() : "no answer in time"));
  }
  asio_->socket.set_option(tcp::no_delay(true), error);
}

Socket::Socket(Socket&&) noexcept = default;
Socket& Socket::operator=(Socket&&) noexcept = default;
Socket::~Socket() = default;

void Socket::send(std::string_view bytes, Deadline deadline) {
  error_code error = net::error::operation_aborted;
  net::async_write(asio_->socket, net::buffer(bytes), [&](error_code write_error, std::size_t) { error = write_error; });
  asio_->finish(deadline);
  if (error == net::error::operation_aborted) throw TimedOut("the server does not read what it is sent");
}

bool Socket::read_some(std::string& bytes, Deadline deadline) {
  std::array<char, 65536> chunk;
  error_code error = net::error::operation_aborted;
  std::size_t size = 0;
  asio_->socket.async_read_some(net::buffer(chunk), [&](error_code read_error, std::size_t read_size) {
    error = read_error;
    size = read_size;
  });
  asio_->finish(deadline);
  if (error == net::error::operation_aborted) throw TimedOut("nothing arrived in time");
  bytes.append(chunk.data(), size);
  return !error;
}

}  // namespace tweend::cli
