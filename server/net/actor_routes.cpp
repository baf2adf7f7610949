#include "server/net/actor_routes.hpp"

#include <fmt/format.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <memory>
#include <utility>

#include "server/commands/export_commands.hpp"

namespace tweend::net {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;

/// A file that is awaited on the network thread.
struct AwaitedFile {
  explicit AwaitedFile(const asio::any_io_executor& executor) : arrived(executor, asio::steady_timer::time_point::max()) {}
  asio::steady_timer arrived;  ///< never expires: cancelled when the file is there
  std::optional<Result<std::string>> file;
};

}  // namespace

std::optional<std::string> parse_actor_file(const ScenePath& path) {
  constexpr std::string_view kFolder = "actors/";
  constexpr std::string_view kExtension = ".glb";
  const std::string_view leaf = path.leaf;
  if (!leaf.starts_with(kFolder) || !leaf.ends_with(kExtension)) return std::nullopt;
  const std::string_view actor = leaf.substr(kFolder.size(), leaf.size() - kFolder.size() - kExtension.size());
  if (leaf.size() <= kFolder.size() + kExtension.size() || actor.find('/') != std::string_view::npos) return std::nullopt;
  return decode_path(actor);
}

asio::awaitable<HttpResponse> answer_actor_file(const HttpRequest& request, const ScenePath& path, std::string actor,
                                                SessionContext& context) {
  const auto awaited = std::make_shared<AwaitedFile>(co_await asio::this_coro::executor);
  context.services.workers.post(
      [awaited, scene = path.scene, actor, services = context.services, to_network = context.to_network] {
        auto file = commands::exported_glb(scene, actor, {services, services.stage.view(), steady_now_us()});
        to_network([awaited, file = std::move(file)]() mutable {
          awaited->file = std::move(file);
          awaited->arrived.cancel();
        });
      });
  while (!awaited->file) co_await awaited->arrived.async_wait(asio::as_tuple(asio::use_awaitable));
  if (!*awaited->file) co_return refuse(request, awaited->file->error());
  HttpResponse response = http_answer(request, 200, "model/gltf-binary", std::move(**awaited->file));
  // The actor is there, so that its name is of letters, digits, '_', '.' and '-': nothing to be escaped.
  response.set(http::field::content_disposition, fmt::format("attachment; filename=\"{}.glb\"", actor));
  co_return response;
}

}  // namespace tweend::net
