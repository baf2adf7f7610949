#include "server/net/websocket_session.hpp"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <memory>
#include <utility>

#include "server/net/outbox_stream.hpp"

namespace tweend::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;

constexpr std::string_view kSubprotocol = "tweend.v1";

/// Whether the client's list of subprotocols names ours.
bool offers_subprotocol(const http::request<http::string_body>& upgrade) {
  for (const auto& offered : http::token_list(upgrade[http::field::sec_websocket_protocol])) {
    if (offered == kSubprotocol) return true;
  }
  return false;
}

void configure(websocket::stream<OutboxStream>& ws, const Limits& limits, bool subprotocol) {
  ws.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));  // Beast has none of its own accord
  ws.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
    if (subprotocol) response.set(http::field::sec_websocket_protocol, kSubprotocol);
  }));
  ws.read_message_max(limits.message_bytes);
  ws.auto_fragment(false);
}

}  // namespace

asio::awaitable<void> run_websocket_session(Tcp::socket socket, http::request<http::string_body> upgrade,
                                            SessionContext& context) {
  const auto connection = std::make_shared<Connection>(std::move(socket), Framing::WebSocket, context.services.metrics);
  connection->begin(context.services, context.to_network, kEveryonesRole);
  websocket::stream<OutboxStream> ws{OutboxStream(connection)};
  configure(ws, context.services.limits, offers_subprotocol(upgrade));
  bool stopping = false;
  const Registered registered(context, [&] {
    stopping = true;
    connection->end_soon(kFarewell);
  });

  constexpr auto kAwait = asio::as_tuple(asio::use_awaitable);
  if (const auto [error] = co_await ws.async_accept(upgrade, kAwait); error) {
    co_await connection->finish(kFarewell);
    co_return;
  }
  beast::flat_buffer buffer;
  while (connection->open()) {
    co_await connection->ready_for_more();
    if (!connection->open()) break;
    const auto [error, bytes] = co_await ws.async_read(buffer, kAwait);
    add(context.services.metrics.bytes_received_total, static_cast<std::int64_t>(bytes));
    if (error) break;                // closed, reset, timed out, too long: Beast has said what there was to say
    if (!connection->open()) break;  // a write has failed meanwhile, and what was read had come before
    if (connection->dismissed()) {
      buffer.consume(buffer.size());
      continue;
    }
    if (!ws.got_text()) {
      const websocket::close_reason reason(websocket::close_code::unknown_data, "expected text messages, found a binary one");
      static_cast<void>(co_await ws.async_close(reason, kAwait));
      break;
    }
    connection->conversation().receive(beast::buffers_to_string(buffer.data()));
    buffer.consume(buffer.size());
  }
  // Behind the answers; the client's close is not waited for.
  constexpr std::uint16_t kGoingAway = 1001;
  co_await connection->finish(kFarewell, stopping ? kGoingAway : 0);
}

}  // namespace tweend::net
