#include "server/net/connection.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <utility>

namespace tweend::net {

namespace asio = boost::asio;

void tune_socket(Tcp::socket& socket) {
  // Unsent bytes that the kernel takes before it says "enough": a slow reader's packets wait in the outbox, where newer ones
  // replace them, and not in the socket, where they grow old.
  constexpr int kUnsentBytes = 128 << 10;
  boost::system::error_code ignored;
  socket.set_option(Tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::keep_alive(true), ignored);
  const auto set = [&socket](int option, int value) {
    ::setsockopt(socket.native_handle(), IPPROTO_TCP, option, &value, sizeof value);
  };
  set(TCP_NOTSENT_LOWAT, kUnsentBytes);
  set(TCP_KEEPIDLE, 30);  // a peer that has gone without a word is noticed within a minute
  set(TCP_KEEPINTVL, 10);
  set(TCP_KEEPCNT, 3);
}

Connection::Connection(Tcp::socket socket, Framing framing, Metrics& metrics)
    : socket_(std::move(socket)),
      framing_(framing),
      outbox_(framing, metrics),
      metrics_(metrics),
      progress_(socket_.get_executor(), asio::steady_timer::time_point::max()),
      farewell_(socket_.get_executor()) {}

void Connection::begin(const commands::Services& services, Post to_network, commands::Role role) {
  conversation_ = std::make_shared<commands::Conversation>(services, std::move(to_network), shared_from_this(), role);
  conversation_->on_progress([this] { progress_.cancel(); });
}

asio::awaitable<void> Connection::ready_for_more() {
  while (open_ && !conversation_->wants_more()) co_await progress_.async_wait(asio::as_tuple(asio::use_awaitable));
}

asio::awaitable<void> Connection::finish(std::chrono::seconds at_most) {
  asio::steady_timer deadline(socket_.get_executor(), at_most);
  // Shared: the timer may have expired, and its handler be on its way, when this ends for another reason.
  const auto late = std::make_shared<bool>(false);
  deadline.async_wait([self = shared_from_this(), late](const boost::system::error_code& error) {
    if (error) return;
    *late = true;
    self->progress_.cancel();
  });
  while (open_ && !*late && !(conversation_->settled() && outbox_.empty())) {
    co_await progress_.async_wait(asio::as_tuple(asio::use_awaitable));
  }
  close();
}

void Connection::end_soon(std::chrono::seconds at_most) {
  boost::system::error_code ignored;
  socket_.shutdown(Tcp::socket::shutdown_receive, ignored);  // ends the session's reading
  // A session that waits for its client to take answers reads nothing and would not notice.
  farewell_.expires_after(at_most);
  farewell_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
    if (!error) self->close();
  });
}

void Connection::close() {
  if (!open_) return;
  open_ = false;
  conversation_->close();
  conversation_.reset();  // it holds this connection, which holds it
  boost::system::error_code ignored;
  socket_.shutdown(Tcp::socket::shutdown_send, ignored);
  socket_.cancel(ignored);
  farewell_.cancel();
  progress_.cancel();
}

void Connection::close_later() {
  // Called from within the conversation, which must not be closed under its own feet.
  asio::post(socket_.get_executor(), [self = shared_from_this()] { self->close(); });
}

void Connection::send(std::string json) {
  outbox_.push_text(std::move(json));
  pump();
}

void Connection::send_shared(std::shared_ptr<const std::string> json) {
  outbox_.push_shared(std::move(json));
  if (outbox_.overflowed()) return close_later();
  pump();
}

void Connection::send_after_packets(std::shared_ptr<const std::string> json) {
  outbox_.push_after_packets(std::move(json));
  if (outbox_.overflowed()) return close_later();
  pump();
}

void Connection::push_raw(std::string bytes) {
  outbox_.push_raw(std::move(bytes));
  pump();
}

void Connection::forget_stream(std::uint32_t stream) { outbox_.forget_stream(stream); }

void Connection::offer(std::uint32_t stream, const streams::PacketPtr& packet) {
  if (!open_ || !conversation_->has_stream(stream)) return;
  outbox_.offer(stream, packet);
  pump();
}

void Connection::ended(std::uint32_t stream, const std::string& reason) {
  if (!open_) return;
  conversation_->stream_ended(stream, reason);
  // Of an answer that is nothing but pictures, this was the end; there is no other way to say so.
  if (framing_ == Framing::Multipart) close_later();
}

void Connection::pump() {
  if (writing_ || !open_) return;
  const auto buffers = outbox_.take();
  if (buffers.empty()) return;
  writing_ = true;
  asio::async_write(socket_, buffers, [self = shared_from_this()](const boost::system::error_code& error, std::size_t bytes) {
    self->written(bytes, static_cast<bool>(error));
  });
}

void Connection::written(std::size_t bytes, bool failed) {
  writing_ = false;
  add(metrics_.bytes_sent_total, static_cast<std::int64_t>(bytes));
  const bool was_congested = outbox_.congested();
  outbox_.written();
  if (failed) return close();
  if (!open_) return;
  if (was_congested && !outbox_.congested()) conversation_->resume();
  pump();
  if (outbox_.empty()) progress_.cancel();
}

}  // namespace tweend::net
