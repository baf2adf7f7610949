#pragma once

#include <boost/asio/awaitable.hpp>
#include <string>

#include "server/net/connection.hpp"
#include "server/net/session_context.hpp"

namespace tweend::net {

/// One HTTP/1.1 client: its requests one after another, until it goes, idles or becomes a WebSocket.
boost::asio::awaitable<void> run_http_session(Tcp::socket socket, std::string received, SessionContext& context);

}  // namespace tweend::net
