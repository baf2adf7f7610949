#include "server/net/connection.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cerrno>
#include <span>
#include <utility>

#include "server/base/clock.hpp"

namespace tweend::net {

namespace asio = boost::asio;

namespace {

ssize_t send_some(int socket, std::span<iovec> buffers) noexcept {
  constexpr int kFlags = MSG_DONTWAIT | MSG_NOSIGNAL;
  if (buffers.size() == 1) return ::send(socket, buffers.front().iov_base, buffers.front().iov_len, kFlags);
  msghdr message{};
  message.msg_iov = buffers.data();
  message.msg_iovlen = buffers.size();
  return ::sendmsg(socket, &message, kFlags);
}

}  // namespace

void tune_socket(Tcp::socket& socket) {
  // Unsent bytes that the kernel takes before it says "enough": a slow reader's packets wait in the outbox, where newer ones
  // replace them, and not in the socket, where they grow old: 32 KiB are an eighth of a second at 2 Mbit/s.
  constexpr int kUnsentBytes = 32 << 10;
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
    : framing_(framing),
      metrics_(metrics),
      outbox_(framing, metrics),
      socket_(std::move(socket)),
      progress_(socket_.get_executor(), asio::steady_timer::time_point::max()),
      farewell_(socket_.get_executor()) {}

void Connection::begin(const commands::Services& services, Post to_network, commands::Role role) {
  conversation_ = std::make_shared<commands::Conversation>(services, std::move(to_network), shared_from_this(), role);
  conversation_->on_progress([this] { progress_.cancel(); });
}

asio::awaitable<void> Connection::ready_for_more() {
  while (open_ && !outbox_.last_said() && !conversation_->wants_more()) {
    co_await progress_.async_wait(asio::as_tuple(asio::use_awaitable));
  }
}

asio::awaitable<void> Connection::finish(std::chrono::seconds at_most, std::uint16_t close_code) {
  asio::steady_timer deadline(socket_.get_executor(), at_most);
  // Shared: the timer may have expired, and its handler be on its way, when this ends for another reason.
  const auto late = std::make_shared<bool>(false);
  deadline.async_wait([self = shared_from_this(), late](const boost::system::error_code& error) {
    if (error) return;
    *late = true;
    self->progress_.cancel();
  });
  while (open_ && !*late && !conversation_->settled()) {
    co_await progress_.async_wait(asio::as_tuple(asio::use_awaitable));
  }
  if (close_code != 0) say_last(close_frame(close_code, {}));
  while (open_ && (dismissed_ || !*late) && !(conversation_->settled() && outbox_.empty())) {
    co_await progress_.async_wait(asio::as_tuple(asio::use_awaitable));
  }
  close();
}

void Connection::end_soon(std::chrono::seconds at_most) {
  boost::system::error_code ignored;
  socket_.shutdown(Tcp::socket::shutdown_receive, ignored);  // ends the session's reading
  // A session that waits for its client to take answers reads nothing and would not notice.
  end_after(at_most);
}

void Connection::end_after(std::chrono::seconds at_most) {
  farewell_.expires_after(at_most);
  farewell_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
    if (!error) self->close();
  });
}

void Connection::close() {
  if (!open_) return;
  open_ = false;
  if (conversation_) conversation_->close();
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

void Connection::say_last(std::string frame) {
  if (!open_ || outbox_.last_said()) return;
  outbox_.push_last(std::move(frame));
  if (conversation_) conversation_->close();
  pump();
  progress_.cancel();
}

void Connection::expect_stream(std::uint32_t stream, commands::StreamPolicy policy) { outbox_.data().expect(stream, policy); }

void Connection::forget_stream(std::uint32_t stream) { outbox_.data().forget(stream); }

void Connection::offer(std::uint32_t stream, const streams::PacketPtr& packet) {
  if (!open_ || outbox_.last_said()) return;
  DataLane& data = outbox_.data();
  // One that was closed meanwhile is not known any more, neither here nor there.
  if (!data.knows(stream) && (!conversation_ || !conversation_->has_stream(stream))) return;
  data.offer(stream, packet, data.adaptive() ? steady_now_us() : 0);
}

void Connection::flush() {
  pump();
  if (!open_ || outbox_.last_said()) return;
  if (full_) outbox_.data().settle_in();
  if (outbox_.data().adaptive()) move_rungs();
  if (const auto behind = outbox_.data().behind()) dismiss(*behind);
}

void Connection::move_rungs() {
  while (const auto move = outbox_.data().next_move()) {
    if (conversation_) conversation_->move_to_rung(move->stream, move->rung);
  }
}

void Connection::ended(std::uint32_t stream, const std::string& reason) {
  if (!open_ || outbox_.last_said()) return;
  outbox_.data().end(stream);
  conversation_->stream_ended(stream, reason);
  // Of an answer that is nothing but pictures, this was the end; there is no other way to say so.
  if (framing_ == Framing::Multipart) close_later();
}

void Connection::dismiss(std::uint32_t stream) {
  constexpr std::uint16_t kTryAgainLater = 1013;  // IANA's registry of WebSocket close codes
  const std::string reason = fmt::format("expected a reader of every packet at most {} bytes behind, found {}; connect again",
                                         DataLane::kEveryBytes, outbox_.data().every_bytes());
  outbox_.drop_data();
  if (conversation_ && framing_ == Framing::Line) conversation_->stream_ended(stream, reason);
  dismissed_ = true;
  end_after(kLastRead);
  say_last(framing_ == Framing::WebSocket ? close_frame(kTryAgainLater, reason) : std::string());
}

/// Writes until nothing waits or the socket is full. Called from within the conversation, too, and so closes nothing itself.
void Connection::pump() {
  while (open_ && !full_) {
    Gathered next;
    outbox_.gather(next);
    if (next.messages() == 0) break;
    const ssize_t written = send_some(socket_.native_handle(), next.buffers());
    if (written < 0) {
      if (errno == EINTR) continue;
      if (errno == EAGAIN || errno == EWOULDBLOCK) return await_room();
      full_ = true;  // for good
      return close_later();
    }
    const auto bytes = static_cast<std::size_t>(written);
    add(metrics_.bytes_sent_total, static_cast<std::int64_t>(bytes));
    outbox_.wrote(next, bytes, outbox_.data().adaptive() ? steady_now_us() : 0);
    if (bytes < next.bytes()) return await_room();
  }
  if (!open_ || !outbox_.empty()) return;
  if (outbox_.last_said()) {
    boost::system::error_code ignored;
    socket_.shutdown(Tcp::socket::shutdown_send, ignored);  // whoever reads to the end finds one
  }
  progress_.cancel();
}

void Connection::await_room() {
  full_ = true;
  socket_.async_wait(Tcp::socket::wait_write, [self = shared_from_this()](const boost::system::error_code& error) {
    if (!self->open_) return;
    self->full_ = false;
    if (error && error != asio::error::operation_aborted) return self->close();
    const bool was_congested = self->outbox_.congested();
    self->flush();
    if (!was_congested || !self->open_ || self->outbox_.congested()) return;
    self->progress_.cancel();
    if (self->conversation_ && !self->outbox_.last_said()) self->conversation_->resume();
  });
}

}  // namespace tweend::net
