#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <string>

#include "server/commands/conversation.hpp"
#include "server/net/outbox.hpp"

namespace tweend::net {

using Tcp = boost::asio::ip::tcp;

/// A client that can be sent things unasked: the socket, its outbox and the one write that is under way. Sessions add the
/// reading side. Network thread only; kept alive by its session and by the conversation, which close() parts.
class Connection final : public commands::Peer, public std::enable_shared_from_this<Connection> {
 public:
  Connection(Tcp::socket socket, Framing framing, Metrics& metrics);

  /// Second half of construction: the conversation needs the connection to be shared.
  void begin(const commands::Services& services, Post to_network, commands::Role role);

  [[nodiscard]] Tcp::socket& socket() noexcept { return socket_; }
  [[nodiscard]] commands::Conversation& conversation() noexcept { return *conversation_; }
  [[nodiscard]] bool open() const noexcept { return open_; }

  /// Returns when the conversation takes another message, or the connection is closed.
  boost::asio::awaitable<void> ready_for_more();
  /// Answers what has been asked and writes all of it, for at most so long; then closes.
  boost::asio::awaitable<void> finish(std::chrono::seconds at_most);
  /// The server stops: nothing more is read than has arrived; whoever does not take its answers within `at_most` loses them.
  void end_soon(std::chrono::seconds at_most);
  /// Framed bytes from elsewhere (Beast's control frames).
  void push_raw(std::string bytes);
  /// Ends it now. What is under way ends unheard.
  void close();

  // commands::Peer
  [[nodiscard]] bool can_push() const noexcept override { return true; }
  void send(std::string json) override;
  void send_shared(std::shared_ptr<const std::string> json) override;
  void send_after_packets(std::shared_ptr<const std::string> json) override;
  [[nodiscard]] bool congested() const noexcept override { return outbox_.congested(); }
  void forget_stream(std::uint32_t stream) override;
  void offer(std::uint32_t stream, const streams::PacketPtr& packet) override;
  void ended(std::uint32_t stream, const std::string& reason) override;

 private:
  void pump();
  void written(std::size_t bytes, bool failed);
  void close_later();

  Tcp::socket socket_;
  const Framing framing_;
  Outbox outbox_;
  Metrics& metrics_;
  std::shared_ptr<commands::Conversation> conversation_;
  boost::asio::steady_timer progress_;  ///< never expires: cancelling it wakes whoever waits for a change
  boost::asio::steady_timer farewell_;  ///< runs while the server stops
  bool open_ = true;
  bool writing_ = false;
};

/// Options that every client socket gets: no delay for small messages, dead peers noticed, little queued in the kernel so
/// that "latest" stays what it says.
void tune_socket(Tcp::socket& socket);

}  // namespace tweend::net
