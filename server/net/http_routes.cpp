#include "server/net/http_routes.hpp"

#include <fmt/format.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <memory>
#include <utility>

#include "protocol/envelope.hpp"
#include "protocol/utf8.hpp"
#include "server/commands/command_table.hpp"
#include "server/commands/conversation.hpp"
#include "server/net/actor_routes.hpp"
#include "server/net/clip_routes.hpp"
#include "server/net/picture_routes.hpp"
#include "server/net/same_origin.hpp"

namespace tweend::net {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;

constexpr std::string_view kText = "text/plain; charset=utf-8";
constexpr std::string_view kJson = "application/json";

/// The client of one POST /rpc: it gets its answers and nothing else.
class RpcPeer final : public commands::Peer {
 public:
  [[nodiscard]] bool can_push() const noexcept override { return false; }
  void send(std::string json) override { answer = std::move(json); }
  void send_shared(std::shared_ptr<const std::string>) override {}
  void send_after_packets(std::shared_ptr<const std::string>) override {}
  [[nodiscard]] bool congested() const noexcept override { return false; }
  void expect_stream(std::uint32_t, commands::StreamPolicy) override {}
  void forget_stream(std::uint32_t) override {}
  void flush() override {}
  void offer(std::uint32_t, const streams::PacketPtr&) override {}
  void ended(std::uint32_t, const std::string&) override {}

  std::string answer;
};

std::string_view path_of(std::string_view target) { return target.substr(0, target.find('?')); }

bool is_json(std::string_view content_type) {
  const auto type = content_type.substr(0, content_type.find(';'));
  return boost::beast::iequals(type.substr(0, type.find_last_not_of(" \t") + 1), kJson);
}

asio::awaitable<HttpResponse> answer_rpc(const HttpRequest& request, SessionContext& context) {
  if (!is_json(request[http::field::content_type])) {
    co_return http_answer(request, 415, kText, "expected Content-Type: application/json\n");
  }
  const auto peer = std::make_shared<RpcPeer>();
  const auto conversation =
      std::make_shared<commands::Conversation>(context.services, context.to_network, peer, kEveryonesRole);
  asio::steady_timer progress(co_await asio::this_coro::executor, asio::steady_timer::time_point::max());
  conversation->on_progress([&progress] { progress.cancel(); });
  if (protocol::is_utf8(request.body())) {
    conversation->receive(request.body());
  } else {
    conversation->reject(fail(ErrorCode::Parse, "expected a body of UTF-8, found other bytes"));
  }
  while (!conversation->settled()) co_await progress.async_wait(asio::as_tuple(asio::use_awaitable));
  conversation->close();
  // Notifications only: there is nothing to say.
  if (peer->answer.empty()) co_return http_answer(request, 204, {}, {});
  co_return http_answer(request, 200, kJson, std::move(peer->answer));
}

std::string welcome() {
  return fmt::format(
      "tweend {}\n\nThis port speaks line JSON, HTTP and WebSocket (/ws, subprotocol tweend.v1).\n"
      "Methods: /openrpc.json · one call: POST /rpc · health: /healthz, /readyz, /metrics\n",
      TWEEND_VERSION);
}

HttpResponse answer_file(const HttpRequest& request, const WebFile& file) {
  const WebAnswer answer = answer_web(file, request[http::field::if_none_match]);
  HttpResponse response = http_answer(request, answer.status, answer.content_type, std::string(answer.body));
  for (const auto& [name, value] : answer.headers) response.set(name, value);
  // Where it says anything, the length is that of the file (RFC 9110, 15.4.5).
  if (answer.status == 304) response.erase(http::field::content_length);
  return response;
}

/// What a GET would be answered, but for its pictures.
HttpResponse answer_stream_head(const HttpRequest& request, const ScenePath& path, const SessionContext& context) {
  auto prepared = prepare_stream(request, path, context);
  if (auto* refusal = std::get_if<HttpResponse>(&prepared)) return std::move(*refusal);
  HttpResponse response = http_answer(request, 200, kMultipartType, {});
  response.erase(http::field::content_length);  // pictures without end have none
  return response;
}

HttpResponse answer_get(const HttpRequest& request, std::string_view path, SessionContext& context) {
  if (path == "/healthz") return http_answer(request, 200, kText, "ok\n");
  if (path == "/readyz") {
    // Documents are loaded before the port opens; while stopping, others should be asked.
    if (context.stopping) return http_answer(request, 503, kText, "stopping\n");
    const render::RenderThread& renderer = context.services.renderer;
    if (renderer.wanted() && !renderer.device())
      return http_answer(request, 503, kText, renderer.device().error().message + "\n");
    return http_answer(request, 200, kText, "ready\n");
  }
  if (path == "/metrics") {
    return http_answer(request, 200, "text/plain; version=0.0.4; charset=utf-8",
                       context.services.metrics.prometheus_text() + context.services.hub.meters().prometheus_text());
  }
  if (path == "/openrpc.json") return http_answer(request, 200, kJson, *commands::openrpc_document());
  if (const WebFile* file = context.web.find(path)) return answer_file(request, *file);
  if (path == "/") return http_answer(request, 200, kText, welcome());
  return http_answer(request, 404, kText,
                     fmt::format("expected /, /healthz, /readyz, /metrics, /openrpc.json, /rpc, /ws, /scenes/SCENE/frame.png, "
                                 "frame.jpg, stream.mjpg, clip.mp4 or actors/ACTOR.glb, found {}\n",
                                 path));
}

}  // namespace

HttpResponse http_answer(const HttpRequest& request, unsigned status, std::string_view content_type, std::string body) {
  HttpResponse response(static_cast<http::status>(status), request.version());
  response.keep_alive(request.keep_alive());
  response.set(http::field::server, "tweend/" TWEEND_VERSION);
  response.set(http::field::cache_control, "no-store");
  response.set("X-Content-Type-Options", "nosniff");
  if (!content_type.empty()) response.set(http::field::content_type, content_type);
  response.body() = std::move(body);
  response.prepare_payload();
  if (request.method() == http::verb::head) response.body().clear();  // the length stays that of the whole
  return response;
}

std::string refuse_request(const HttpRequest& request, const SessionContext& context) {
  std::optional<std::string> origin;
  const bool upgrade = path_of(request.target()) == "/ws";
  const bool reads = request.method() == http::verb::get || request.method() == http::verb::head;
  if (const auto at = request.find(http::field::origin); at != request.end() && (upgrade || !reads))
    origin = std::string(at->value());
  return refuse_origin(request[http::field::host], origin, context.allowed_origins);
}

std::size_t body_limit(std::string_view target, const Limits& limits) noexcept {
  return path_of(target) == "/rpc" ? limits.message_bytes : 1U << 20U;
}

asio::awaitable<HttpResponse> route(const HttpRequest& request, Tcp::socket& socket, SessionContext& context) {
  const std::string_view path = path_of(request.target());
  if (path == "/rpc") {
    if (request.method() == http::verb::post) co_return co_await answer_rpc(request, context);
    auto response = http_answer(request, 405, kText, "expected POST\n");
    response.set(http::field::allow, "POST");
    co_return response;
  }
  if (path == "/ws") {
    auto response = http_answer(request, 426, kText, "expected a WebSocket upgrade\n");
    response.set(http::field::upgrade, "websocket");
    co_return response;
  }
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    auto response = http_answer(request, 405, kText, "expected GET or HEAD\n");
    response.set(http::field::allow, "GET, HEAD");
    co_return response;
  }
  if (const auto scene = parse_scene_path(path)) {
    if (scene->leaf == "frame.png" || scene->leaf == "frame.jpg") co_return co_await answer_frame(request, *scene, context);
    if (scene->leaf == "clip.mp4") co_return co_await answer_clip(request, *scene, socket, context);
    // A GET of it never comes here: it becomes a session of its own.
    if (scene->leaf == "stream.mjpg") co_return answer_stream_head(request, *scene, context);
    if (const auto actor = parse_actor_file(*scene)) co_return co_await answer_actor_file(request, *scene, *actor, context);
  }
  co_return answer_get(request, path, context);
}

}  // namespace tweend::net
