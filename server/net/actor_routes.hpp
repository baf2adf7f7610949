#pragma once

#include <boost/asio/awaitable.hpp>
#include <optional>
#include <string>

#include "server/net/http_routes.hpp"
#include "server/net/picture_routes.hpp"

namespace tweend::net {

/// The actor that a path /scenes/{scene}/actors/{actor}.glb names; nothing for other paths.
[[nodiscard]] std::optional<std::string> parse_actor_file(const ScenePath& path);

/// GET of an actor's .glb: it is made on a worker.
boost::asio::awaitable<HttpResponse> answer_actor_file(const HttpRequest& request, const ScenePath& path, std::string actor,
                                                       SessionContext& context);

}  // namespace tweend::net
