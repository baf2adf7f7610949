#pragma once

#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "protocol/json_value.hpp"
#include "server/commands/stream_types.hpp"
#include "server/net/connection.hpp"
#include "server/net/http_routes.hpp"

namespace tweend::net {

/// A path /scenes/{scene}/{leaf}.
struct ScenePath {
  std::string scene;
  std::string_view leaf;  ///< "frame.png", "stream.mjpg", …
};
[[nodiscard]] std::optional<ScenePath> parse_scene_path(std::string_view path);

/// A part of a path without its escapes (RFC 3986, 2.1); empty where that is no UTF-8.
[[nodiscard]] std::string decode_path(std::string_view text);
/// The answer of a request that is refused for this reason.
[[nodiscard]] HttpResponse refuse(const HttpRequest& request, const Error& error);

/// The same where so many wait already that it is worth asking again in a while.
[[nodiscard]] HttpResponse refuse_for_now(const HttpRequest& request, const Error& error, std::chrono::seconds retry_after);

/// What the path has said already.
struct Member {
  std::string_view name;
  std::string_view value;
};
/// The query's pairs as a JSON object: what reads as a JSON number becomes one, everything else a string. `token`, which
/// says who asks and not what for, is left out.
/// @return InvalidParams where the query says what the path says, or says something twice
[[nodiscard]] Result<std::string> query_json(std::string_view target, std::initializer_list<Member> given);
/// The query as parameters of type P, as if they had come by JSON-RPC.
template <class P>
[[nodiscard]] Result<P> query_params(const HttpRequest& request, std::initializer_list<Member> given,
                                     const SessionContext& context) {
  TWEEND_ASSIGN(const std::string json, query_json(request.target(), given));
  TWEEND_ASSIGN(const protocol::JsonValue value, protocol::JsonValue::parse(json, context.services.limits));
  P params;
  TWEEND_TRY(protocol::decode(value, protocol::type_of<P>(), &params, "params"));
  return params;
}

/// GET frame.png and frame.jpg: one picture.
boost::asio::awaitable<HttpResponse> answer_frame(const HttpRequest& request, const ScenePath& path, SessionContext& context);

/// GET stream.mjpg: what is to be streamed, or the answer that says why not.
[[nodiscard]] std::variant<commands::StreamOpenParams, HttpResponse> prepare_stream(const HttpRequest& request,
                                                                                    const ScenePath& path,
                                                                                    const SessionContext& context);
/// Sends pictures, each a part of one endless answer (multipart/x-mixed-replace), until the client goes.
boost::asio::awaitable<void> run_picture_session(Tcp::socket socket, commands::StreamOpenParams params,
                                                 SessionContext& context);

}  // namespace tweend::net
