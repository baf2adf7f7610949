#include "server/net/http_session.hpp"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <cstring>
#include <optional>
#include <utility>
#include <variant>

#include "protocol/envelope.hpp"
#include "server/net/http_routes.hpp"
#include "server/net/picture_routes.hpp"
#include "server/net/websocket_session.hpp"

namespace tweend::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;

constexpr auto kAwait = asio::as_tuple(asio::use_awaitable);
constexpr std::uint32_t kHeaderBytes = 16U << 10U;
/// Of clients that read a large file, and of those that keep others from a film meanwhile.
constexpr std::size_t kSlowestBytesPerSecond = 64U << 10U, kSlowestFilmBytesPerSecond = 1U << 20U;

asio::awaitable<bool> write(beast::tcp_stream& stream, const HttpResponse& response, Metrics& metrics) {
  const std::size_t slowest = response.film ? kSlowestFilmBytesPerSecond : kSlowestBytesPerSecond;
  stream.expires_after(kHttpIdle + std::chrono::seconds(response.body().size() / slowest));
  const auto [error, bytes] = co_await http::async_write(stream, response, kAwait);
  add(metrics.bytes_sent_total, static_cast<std::int64_t>(bytes));
  co_return !error;
}

/// What a request that can't be read is answered, if it is worth an answer.
std::optional<HttpResponse> answer_to_failure(const boost::system::error_code& error, const Limits& limits) {
  HttpRequest nobody{http::verb::get, "/", 11};
  nobody.keep_alive(false);
  if (error == http::error::body_limit) {
    const Error reason = fail(
        ErrorCode::Limit, "expected a body of at most " + std::to_string(limits.message_bytes) + " bytes, found a longer one");
    return http_answer(nobody, 413, "application/json", protocol::answer_json("null", reason));
  }
  if (error == http::error::header_limit) return http_answer(nobody, 431, "text/plain", "expected a shorter header\n");
  if (error == http::error::end_of_stream || error == http::error::partial_message) return std::nullopt;
  if (error.category() == http::make_error_code(http::error::bad_target).category()) {
    return http_answer(nobody, 400, "text/plain", "expected an HTTP/1.1 request: " + error.message() + "\n");
  }
  return std::nullopt;  // reset or timed out
}

/// Reads one request, its header first: the target says how large the body may be.
asio::awaitable<boost::system::error_code> read_request(beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                                        const Limits& limits, Metrics& metrics, HttpRequest& request) {
  http::request_parser<http::string_body> parser;
  parser.header_limit(kHeaderBytes);
  parser.body_limit(boost::none);
  stream.expires_after(kHttpIdle);
  const auto [header_error, header_bytes] = co_await http::async_read_header(stream, buffer, parser, kAwait);
  add(metrics.bytes_received_total, static_cast<std::int64_t>(header_bytes));
  if (header_error) co_return header_error;
  parser.body_limit(body_limit(parser.get().target(), limits));
  if (parser.content_length() && *parser.content_length() > body_limit(parser.get().target(), limits)) {
    co_return http::make_error_code(http::error::body_limit);
  }
  if (beast::iequals(parser.get()[http::field::expect], "100-continue")) {
    const http::response<http::empty_body> go_on(http::status::continue_, 11);
    co_await http::async_write(stream, go_on, kAwait);  // if this fails, so does the read
  }
  const auto [error, bytes] = co_await http::async_read(stream, buffer, parser, kAwait);
  add(metrics.bytes_received_total, static_cast<std::int64_t>(bytes));
  if (!error) request = parser.release();
  co_return error;
}

/// What a connection becomes once its requests have been answered.
struct Upgrade {};  ///< a WebSocket: the last request asks for it and may have it
using Next = std::variant<std::monostate, Upgrade, commands::StreamOpenParams>;

bool is_websocket(const HttpRequest& request) {
  return beast::websocket::is_upgrade(request) && request.target().substr(0, request.target().find('?')) == "/ws";
}

/// Whether the request asks for pictures without end.
std::optional<ScenePath> picture_stream(const HttpRequest& request) {
  if (request.method() != http::verb::get) return std::nullopt;
  auto path = parse_scene_path(request.target().substr(0, request.target().find('?')));
  return path && path->leaf == "stream.mjpg" ? path : std::nullopt;
}

/// The requests of one client, one after another.
asio::awaitable<Next> serve_requests(beast::tcp_stream& stream, beast::flat_buffer& buffer, SessionContext& context,
                                     HttpRequest& request) {
  Metrics& metrics = context.services.metrics;
  for (;;) {
    request = {};
    if (const auto error = co_await read_request(stream, buffer, context.services.limits, metrics, request); error) {
      if (const auto answer = answer_to_failure(error, context.services.limits)) co_await write(stream, *answer, metrics);
      co_return Next();
    }
    stream.expires_never();  // a command takes as long as it takes
    const std::string refusal = refuse_request(request, context);
    if (!refusal.empty()) {
      if (!co_await write(stream, http_answer(request, 403, "text/plain; charset=utf-8", refusal + "\n"), metrics))
        co_return Next();
    } else if (is_websocket(request)) {
      co_return Upgrade();
    } else if (const auto path = picture_stream(request)) {
      auto prepared = prepare_stream(request, *path, context);
      if (auto* params = std::get_if<commands::StreamOpenParams>(&prepared)) co_return std::move(*params);
      if (!co_await write(stream, std::get<HttpResponse>(prepared), metrics)) co_return Next();
    } else if (!co_await write(stream, co_await route(request, stream.socket(), context), metrics)) {
      co_return Next();
    }
    // While the server stops, reading ends by itself behind the requests that have arrived.
    if (!request.keep_alive()) co_return Next();
  }
}

}  // namespace

asio::awaitable<void> run_http_session(Tcp::socket socket, std::string received, SessionContext& context) {
  beast::tcp_stream stream(std::move(socket));
  beast::flat_buffer buffer;
  std::memcpy(buffer.prepare(received.size()).data(), received.data(), received.size());
  buffer.commit(received.size());
  HttpRequest request;
  Next next;
  {
    const Registered registered(context, [&stream] {
      boost::system::error_code ignored;
      stream.socket().shutdown(Tcp::socket::shutdown_receive, ignored);
    });
    next = co_await serve_requests(stream, buffer, context, request);
  }
  if (auto* pictures = std::get_if<commands::StreamOpenParams>(&next)) {
    co_await run_picture_session(stream.release_socket(), std::move(*pictures), context);
    co_return;
  }
  if (std::holds_alternative<Upgrade>(next)) {
    // A client may not send frames before it has read the answer (RFC 6455, 4.1): what came behind the request is dropped.
    co_await run_websocket_session(stream.release_socket(), std::move(request), context);
    co_return;
  }
  boost::system::error_code ignored;
  stream.socket().shutdown(Tcp::socket::shutdown_send, ignored);
}

}  // namespace tweend::net
