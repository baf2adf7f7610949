#pragma once

#include <boost/asio/awaitable.hpp>
#include <string>

#include "server/net/connection.hpp"
#include "server/net/session_context.hpp"

namespace tweend::net {

/// One client of line JSON, from its first bytes to its last.
/// @param received  what has been read already
boost::asio::awaitable<void> run_line_session(Tcp::socket socket, std::string received, SessionContext& context);

}  // namespace tweend::net
