#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <memory>
#include <string>
#include <string_view>

#include "server/net/connection.hpp"
#include "server/net/session_context.hpp"

namespace tweend::net {

using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;
struct HttpResponse : boost::beast::http::response<boost::beast::http::string_body> {
  using boost::beast::http::response<boost::beast::http::string_body>::response;
  std::shared_ptr<const void> film;  ///< the place of a film among those in memory; null: it is none
};

/// A plain answer; keeps or closes the connection as the request asked for.
[[nodiscard]] HttpResponse http_answer(const HttpRequest& request, unsigned status, std::string_view content_type,
                                       std::string body);

/// Why the request is refused before it is looked at further: Host and Origin. Empty: it may pass.
[[nodiscard]] std::string refuse_request(const HttpRequest& request, const SessionContext& context);

/// What may be sent as the body of a request for this target, bytes.
[[nodiscard]] std::size_t body_limit(std::string_view target, const Limits& limits) noexcept;

/// Answers a request that is not an upgrade.
/// @param socket  the client's: only to look whether it is still there
boost::asio::awaitable<HttpResponse> route(const HttpRequest& request, Tcp::socket& socket, SessionContext& context);

}  // namespace tweend::net
