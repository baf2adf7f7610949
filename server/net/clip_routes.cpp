#include "server/net/clip_routes.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "server/commands/edit_helpers.hpp"
#include "server/commands/frame_types.hpp"
#include "server/commands/stream_types.hpp"
#include "server/streams/film_range.hpp"

namespace tweend::net {
namespace {

namespace asio = boost::asio;

constexpr double kDefaultFps = 30.0;
/// How often it is looked whether the client of a film is still there.
constexpr std::chrono::milliseconds kLook{250};
/// When whoever finds too many before him may try again.
constexpr std::chrono::seconds kRetryFilm{10};

struct ClipParams {
  static constexpr std::string_view kName = "ClipFileParams";
  std::optional<std::string> scene, actor;
  std::optional<double> from, to, fps;
  std::optional<std::uint64_t> width, height;
  static void describe(commands::FieldList<ClipParams>& f) {
    using T = ClipParams;
    commands::add_scene_field(f);
    f.add<&T::actor>("actor", "Whose clip says how long the film is; the first if left out.");
    f.add<&T::from>("from", "Media seconds; 0 if left out.", protocol::kNotNegative);
    f.add<&T::to>("to", "Media seconds, not shown itself; the clip's end if left out.", protocol::kNotNegative);
    f.add<&T::fps>("fps", "Pictures a second; 30 if left out.", commands::kFilmRate);
    f.add<&T::width>("width", "Pixels, even; 1280 if left out.", commands::kPixels);
    f.add<&T::height>("height", "Pixels, even; 720 if left out.", commands::kPixels);
  }
};

/// How long the current clip of an actor is, the first one's if none is named.
Result<double> clip_duration_s(const stage::SceneView& view, const std::optional<std::string>& actor) {
  if (view.scene->actors.empty()) {
    return fail(ErrorCode::NotFound, fmt::format("expected an actor in the scene \"{}\", found none", view.scene->name));
  }
  const std::string& name = actor ? *actor : view.scene->actors.front()->name;
  const model::ActorPtr found = view.scene->find_actor(name);
  if (!found)
    return fail(ErrorCode::NotFound, fmt::format("expected an actor, found none called \"{}\"", name), "params.actor");
  return stage::clip_of(*found, *view.find_player(name))->duration_s();
}

Result<streams::ClipFilm> film_of(const ClipParams& p, const std::string& scene, const commands::Services& services) {
  streams::ClipFilm film;
  film.now_us = steady_now_us();
  film.view = services.stage.view()->find(scene);
  if (!film.view) return commands::no_such_scene(scene);
  TWEEND_ASSIGN(const double duration_s, clip_duration_s(*film.view, p.actor));
  film.from_s = p.from.value_or(0.0);
  film.fps = p.fps.value_or(kDefaultFps);
  TWEEND_ASSIGN(film.pictures,
                streams::pictures_of({film.from_s, p.to, film.fps}, duration_s, services.limits.film_pictures, "params."));
  TWEEND_ASSIGN(film.size, commands::frame_size(p.width, p.height, services));
  TWEEND_TRY(commands::check_even(film.size));
  return film;
}

/// A film that is awaited on the network thread.
struct AwaitedFilm {
  explicit AwaitedFilm(const asio::any_io_executor& executor) : arrived(executor) {}
  asio::steady_timer arrived;  ///< cancelled when the film is there
  std::optional<Result<streams::MadeFilm>> made;
};

/// Whether the other side has closed or reset the connection; what it sent before may still be unread.
bool has_left(Tcp::socket& socket) {
  pollfd look{socket.native_handle(), POLLRDHUP, 0};
  return ::poll(&look, 1, 0) > 0;
}

}  // namespace

asio::awaitable<HttpResponse> answer_clip(const HttpRequest& request, const ScenePath& path, Tcp::socket& socket,
                                          SessionContext& context) {
  const auto params = query_params<ClipParams>(request, {{"scene", path.scene}}, context);
  if (!params) co_return refuse(request, params.error());
  Result<streams::ClipFilm> film = film_of(*params, path.scene, context.services);
  if (!film) co_return refuse(request, film.error());
  const auto awaited = std::make_shared<AwaitedFilm>(co_await asio::this_coro::executor);
  // Held here alone: with this coroutine the interest in the film ends.
  const auto interest = std::make_shared<const char>();
  const Status taken = context.services.films.make(std::move(*film), interest,
                                                   [awaited, to_network = context.to_network](Result<streams::MadeFilm> made) {
                                                     to_network([awaited, made = std::move(made)]() mutable {
                                                       awaited->made = std::move(made);
                                                       awaited->arrived.cancel();
                                                     });
                                                   });
  if (!taken) co_return refuse_for_now(request, taken.error(), kRetryFilm);
  while (!awaited->made) {
    awaited->arrived.expires_after(kLook);
    co_await awaited->arrived.async_wait(asio::as_tuple(asio::use_awaitable));
    // A server that stops has closed the socket's reading side itself, and its films end by themselves.
    if (awaited->made || context.stopping || !has_left(socket)) continue;
    HttpResponse gone = refuse(request, fail(ErrorCode::Unavailable,
                                             "expected a client that waits for the film, found that it has "
                                             "closed its side; keep the connection open until the answer"));
    gone.keep_alive(false);
    co_return gone;
  }
  if (!*awaited->made) co_return refuse(request, awaited->made->error());
  streams::MadeFilm& made = **awaited->made;
  HttpResponse response = http_answer(request, 200, "video/mp4", std::move(made.file));
  response.film = std::move(made.place);
  co_return response;
}

}  // namespace tweend::net
