#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/asio/compose.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/role.hpp>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "server/net/connection.hpp"

namespace tweend::net {

/// Beast's write: one unit, into the outbox. It is done when the client has room for more answers, and so Beast, which waits
/// for each of its pongs to be written, reads no more pings of a client that does not read.
struct UnitWrite {
  std::shared_ptr<Connection> connection;
  std::string unit;
  std::size_t bytes = unit.size();
  bool begun = false;

  template <class Self>
  void operator()(Self& self, boost::system::error_code = {}) {
    constexpr char kCloseFrame = '\x88';  // FIN, opcode 8: nothing of the handshake begins like this
    const auto alive = connection;        // moves away with `self`
    if (!begun) {
      begun = true;
      if (unit.starts_with(kCloseFrame)) {
        alive->say_last(std::move(unit));
      } else {
        alive->push_raw(std::move(unit));
      }
      boost::asio::post(alive->socket().get_executor(), std::move(self));
    } else if (!alive->open()) {
      self.complete(boost::asio::error::operation_aborted, 0);
    } else if (alive->congested()) {
      alive->progress().async_wait(std::move(self));
    } else {
      self.complete({}, bytes);
    }
  }
};

/// A connection as Beast's WebSocket sees it (an AsyncStream): reads come from the socket, writes go into the outbox.
///
/// Beast then speaks the handshake, answers pings and closes; messages and packets are framed by the outbox. Each control
/// frame is written as one unit, so it can't fall inside one of those, and there is one writer only.
class OutboxStream {
 public:
  using executor_type = Tcp::socket::executor_type;

  explicit OutboxStream(std::shared_ptr<Connection> connection) : connection_(std::move(connection)) {}

  executor_type get_executor() { return connection_->socket().get_executor(); }
  Connection& connection() noexcept { return *connection_; }

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return connection_->socket().async_read_some(buffers, std::forward<Token>(token));
  }

  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    std::string unit(boost::asio::buffer_size(buffers), '\0');
    boost::asio::buffer_copy(boost::asio::buffer(unit), buffers);
    return boost::asio::async_compose<Token, void(boost::system::error_code, std::size_t)>(
        UnitWrite{connection_, std::move(unit)}, token, get_executor());
  }

 private:
  std::shared_ptr<Connection> connection_;
};

// Beast finds these by argument-dependent lookup. Ending the connection is the session's business: it lets the outbox, and
// with it Beast's own close frame, run empty first.
inline void teardown(boost::beast::role_type, OutboxStream&, boost::system::error_code& error) { error = {}; }

template <class Handler>
void async_teardown(boost::beast::role_type, OutboxStream& stream, Handler&& handler) {
  boost::asio::post(stream.get_executor(),
                    [handler = std::forward<Handler>(handler)]() mutable { std::move(handler)(boost::system::error_code()); });
}

inline void beast_close_socket(OutboxStream& stream) { stream.connection().close(); }

}  // namespace tweend::net
