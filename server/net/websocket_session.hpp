#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <string>

#include "server/net/connection.hpp"
#include "server/net/session_context.hpp"

namespace tweend::net {

/// One WebSocket client, from its upgrade request to its close.
/// @param received  bytes that came behind the request already
boost::asio::awaitable<void> run_websocket_session(Tcp::socket socket,
                                                   boost::beast::http::request<boost::beast::http::string_body> upgrade,
                                                   SessionContext& context);

}  // namespace tweend::net
