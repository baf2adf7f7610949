#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "server/commands/conversation.hpp"
#include "server/net/outbox.hpp"

namespace tweend::net {

using Tcp = boost::asio::ip::tcp;

/// A client that can be sent things unasked: the socket and its outbox. What is sent is written at once, as far as the socket
/// takes it; for the rest the connection waits. Sessions add the reading side. Network thread only; kept alive by its session
/// and by the conversation, which close() parts.
class Connection final : public commands::Peer, public std::enable_shared_from_this<Connection> {
 public:
  Connection(Tcp::socket socket, Framing framing, Metrics& metrics);

  /// Second half of construction: the conversation needs the connection to be shared. Without it there is nobody who could
  /// have opened a stream: those that expect_stream() was told of are sent all the same.
  void begin(const commands::Services& services, Post to_network, commands::Role role);

  [[nodiscard]] Tcp::socket& socket() noexcept { return socket_; }
  [[nodiscard]] commands::Conversation& conversation() noexcept { return *conversation_; }
  [[nodiscard]] bool open() const noexcept { return open_; }
  /// It fell too far behind and has been told to come back: what it says is not heard any more, and it ends as soon as the
  /// client does, or after kLastRead.
  [[nodiscard]] bool dismissed() const noexcept { return dismissed_; }

  /// Returns when the conversation takes another message, or the connection is closed.
  boost::asio::awaitable<void> ready_for_more();
  /// Answers what has been asked and writes all of it, for at most so long; then closes.
  /// @param close_code  of a WebSocket's close frame, which is said last; 0: none is
  boost::asio::awaitable<void> finish(std::chrono::seconds at_most, std::uint16_t close_code = 0);
  /// The server stops: nothing more is read than has arrived; whoever does not take its answers within `at_most` loses them.
  void end_soon(std::chrono::seconds at_most);
  /// Framed bytes from elsewhere (Beast's control frames).
  void push_raw(std::string bytes);
  /// A close frame: nothing is sent behind it, so packets that wait are dropped, and whatever is under way ends unheard.
  /// Further ones are passed over. Not from within the conversation.
  void say_last(std::string frame);
  /// Never expires; cancelled when more has been taken, or asked, or the connection is closed.
  [[nodiscard]] boost::asio::steady_timer& progress() noexcept { return progress_; }
  /// Ends it now. What is under way ends unheard.
  void close();

  // commands::Peer
  [[nodiscard]] bool can_push() const noexcept override { return true; }
  void send(std::string json) override;
  void send_shared(std::shared_ptr<const std::string> json) override;
  void send_after_packets(std::shared_ptr<const std::string> json) override;
  [[nodiscard]] bool congested() const noexcept override { return outbox_.congested(); }
  void expect_stream(std::uint32_t stream, commands::StreamPolicy policy) override;
  void forget_stream(std::uint32_t stream) override;
  void flush() override;
  void offer(std::uint32_t stream, const streams::PacketPtr& packet) override;
  void ended(std::uint32_t stream, const std::string& reason) override;

 private:
  void pump();
  void await_room();
  void move_rungs();
  void dismiss(std::uint32_t stream);
  void end_after(std::chrono::seconds at_most);
  void close_later();

  // What each packet touches stands together.
  bool open_ = true;
  bool full_ = false;  ///< the socket takes nothing for now
  bool dismissed_ = false;
  const Framing framing_;
  Metrics& metrics_;
  Outbox outbox_;
  Tcp::socket socket_;
  std::shared_ptr<commands::Conversation> conversation_;
  boost::asio::steady_timer progress_;
  boost::asio::steady_timer farewell_;  ///< runs while the server stops, or the client is to read its dismissal
};

/// How long a client that has been dismissed may take to read what is on its way.
inline constexpr std::chrono::seconds kLastRead{30};

/// Options that every client socket gets: no delay for small messages, dead peers noticed, little queued in the kernel so
/// that "latest" stays what it says.
void tune_socket(Tcp::socket& socket);

}  // namespace tweend::net
