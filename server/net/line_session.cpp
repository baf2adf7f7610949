#include "server/net/line_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <memory>
#include <string_view>
#include <utility>

#include "protocol/utf8.hpp"

namespace tweend::net {
namespace {

namespace asio = boost::asio;

constexpr std::size_t kReadBytes = 64U << 10U;
/// What a client that was refused may still send before the connection is reset under it.
constexpr std::size_t kLingerBytes = 256U << 10U;

bool is_blank(std::string_view line) { return line.find_first_not_of(" \t\r\n\v\f") == std::string_view::npos; }

/// Cuts the stream of bytes into lines and hands them on.
class LineReader {
 public:
  LineReader(Connection& connection, const Limits& limits) : connection_(connection), limits_(limits) {}

  /// Takes as many whole lines as the conversation wants. False: the client must go.
  bool take_lines(std::string& buffer) {
    std::size_t begin = 0;
    bool good = true;
    while (good && connection_.conversation().wants_more()) {
      const std::size_t end = buffer.find('\n', std::max(begin, searched_));
      if (end == std::string::npos) {
        searched_ = buffer.size();
        if (buffer.size() - begin > limits_.message_bytes) good = too_long();
        break;
      }
      searched_ = end + 1;
      good = take(std::string_view(buffer).substr(begin, end - begin));
      begin = end + 1;
    }
    buffer.erase(0, begin);
    searched_ -= std::min(searched_, begin);
    return good;
  }

  bool take(std::string_view line) {
    if (is_blank(line)) return true;
    if (line.size() > limits_.message_bytes) return too_long();
    if (!protocol::is_utf8(line)) {
      connection_.conversation().reject(
          fail(ErrorCode::Parse, "expected a line of UTF-8, found other bytes; the connection is closed"));
      return false;
    }
    connection_.conversation().receive(std::string(line));
    return true;
  }

 private:
  bool too_long() {
    connection_.conversation().reject(
        fail(ErrorCode::Limit, fmt::format("expected a line of at most {} bytes, found a longer one; the connection is closed",
                                           limits_.message_bytes)));
    return false;
  }

  Connection& connection_;
  const Limits& limits_;
  std::size_t searched_ = 0;  ///< no line ends before this
};

// Reads on for a moment after the last word, so that the client gets to see it: closing with unread bytes would reset the
// connection and take the answer along.
asio::awaitable<void> linger(std::shared_ptr<Connection> connection) {
  std::array<char, 4096> ignored;
  std::size_t left = kLingerBytes;
  asio::steady_timer deadline(connection->socket().get_executor(), kFarewell);
  deadline.async_wait([connection](const boost::system::error_code& error) {
    boost::system::error_code ignored_too;
    if (!error) connection->socket().cancel(ignored_too);
  });
  while (left > 0) {
    const auto [error, bytes] =
        co_await connection->socket().async_read_some(asio::buffer(ignored), asio::as_tuple(asio::use_awaitable));
    if (error) break;
    left -= std::min(left, bytes);
  }
}

}  // namespace

asio::awaitable<void> run_line_session(Tcp::socket socket, std::string received, SessionContext& context) {
  const auto connection = std::make_shared<Connection>(std::move(socket), Framing::Line, context.services.metrics);
  connection->begin(context.services, context.to_network, kEveryonesRole);
  const Registered registered(context, [&connection] { connection->end_soon(kFarewell); });
  LineReader reader(*connection, context.services.limits);
  std::string buffer = std::move(received);
  bool refused = false;
  while (connection->open()) {
    if (connection->dismissed()) {
      buffer.clear();  // nothing of it is heard
    } else if (!reader.take_lines(buffer)) {
      refused = true;
      break;
    } else if (!connection->conversation().wants_more()) {
      co_await connection->ready_for_more();
      continue;
    }
    const std::size_t before = buffer.size();
    buffer.resize(before + kReadBytes);
    const auto [error, bytes] = co_await connection->socket().async_read_some(asio::buffer(buffer.data() + before, kReadBytes),
                                                                              asio::as_tuple(asio::use_awaitable));
    buffer.resize(before + bytes);
    add(context.services.metrics.bytes_received_total, static_cast<std::int64_t>(bytes));
    if (!error) continue;
    // A last line may come without its end: `printf '{…}' | nc` is answered too.
    if (error == asio::error::eof && connection->open() && !connection->dismissed() && !buffer.empty())
      static_cast<void>(reader.take(buffer));
    break;
  }
  co_await connection->finish(kFarewell);
  if (refused) co_await linger(connection);
}

}  // namespace tweend::net
