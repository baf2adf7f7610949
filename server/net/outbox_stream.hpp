#pragma once

#include <boost/asio/associated_executor.hpp>
#include <boost/asio/async_result.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/role.hpp>
#include <memory>
#include <string>
#include <utility>

#include "server/net/connection.hpp"

namespace tweend::net {

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
    return boost::asio::async_initiate<Token, void(boost::system::error_code, std::size_t)>(
        [this](auto handler, const Buffers& bytes) {
          std::string unit(boost::asio::buffer_size(bytes), '\0');
          boost::asio::buffer_copy(boost::asio::buffer(unit), bytes);
          const std::size_t size = unit.size();
          connection_->push_raw(std::move(unit));
          const auto executor = boost::asio::get_associated_executor(handler, get_executor());  // before the handler moves
          boost::asio::post(executor, [handler = std::move(handler), size]() mutable {
            std::move(handler)(boost::system::error_code(), size);
          });
        },
        token, buffers);
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
