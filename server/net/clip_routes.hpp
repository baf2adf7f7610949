#pragma once

#include <boost/asio/awaitable.hpp>

#include "server/net/http_routes.hpp"
#include "server/net/picture_routes.hpp"

namespace tweend::net {

/// GET clip.mp4: a film of each actor's current clip, at times of its own. One that takes its client's patience ends: `socket`
/// tells when it has closed its side. What it has sent meanwhile stays there.
boost::asio::awaitable<HttpResponse> answer_clip(const HttpRequest& request, const ScenePath& path, Tcp::socket& socket,
                                                 SessionContext& context);

}  // namespace tweend::net
