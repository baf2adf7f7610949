#include "server/net/picture_routes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <memory>
#include <utility>

#include "protocol/json_value.hpp"
#include "protocol/utf8.hpp"

namespace tweend::net {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;

constexpr std::string_view kText = "text/plain; charset=utf-8";

/// When whoever finds too many before him may try again: some of a thousand pictures are drawn by then.
constexpr std::chrono::seconds kRetryPicture{1};

int hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// RFC 3986, 2.1; in a query also '+' for a space. What is no escape stays as it is, and what is no UTF-8 then is none.
std::string decoded(std::string_view text, bool query) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
    if (low >= 0) {
      out += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      out += query && text[i] == '+' ? ' ' : text[i];
    }
  }
  return protocol::is_utf8(out) ? out : std::string();
}

unsigned http_status(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::NotFound:
      return 404;
    case ErrorCode::Unavailable:
      return 503;
    case ErrorCode::Internal:
      return 500;
    default:
      return 400;
  }
}

/// Whether a text is a number of JSON.
bool is_number(std::string_view text) {
  const bool begins = !text.empty() && (text.front() == '-' || (text.front() >= '0' && text.front() <= '9'));
  return begins && protocol::JsonValue::parse(text, Limits{}).has_value();
}

/// A picture that is awaited on the network thread.
struct Awaited {
  explicit Awaited(const asio::any_io_executor& executor) : arrived(executor, asio::steady_timer::time_point::max()) {}
  asio::steady_timer arrived;  ///< never expires: cancelled when the picture is there
  std::optional<Result<std::string>> file;
};

}  // namespace

HttpResponse refuse(const HttpRequest& request, const Error& error) {
  const std::string path = error.path.empty() ? "" : error.path + ": ";
  return http_answer(request, http_status(error.code), kText, path + error.message + "\n");
}

HttpResponse refuse_for_now(const HttpRequest& request, const Error& error, std::chrono::seconds retry_after) {
  HttpResponse response = refuse(request, error);
  response.set(http::field::retry_after, std::to_string(retry_after.count()));
  return response;
}

std::string decode_path(std::string_view text) { return decoded(text, false); }

std::optional<ScenePath> parse_scene_path(std::string_view path) {
  constexpr std::string_view kPrefix = "/scenes/";
  if (!path.starts_with(kPrefix)) return std::nullopt;
  path.remove_prefix(kPrefix.size());
  const std::size_t slash = path.find('/');
  if (slash == std::string_view::npos || slash == 0) return std::nullopt;
  return ScenePath{decoded(path.substr(0, slash), false), path.substr(slash + 1)};
}

Result<std::string> query_json(std::string_view target, std::initializer_list<Member> given) {
  std::string json = "{";
  std::vector<std::string> names;
  const auto add = [&json](std::string_view name, std::string_view value) {
    if (json.size() > 1) json += ',';
    protocol::append_json_string(name, json);
    json += ':';
    if (is_number(value)) {
      json += value;
    } else {
      protocol::append_json_string(value, json);
    }
  };
  const std::size_t mark = target.find('?');
  std::string_view rest = mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(rest.size(), pair.size() + 1));
    const std::size_t equals = pair.find('=');
    const std::string name = decoded(pair.substr(0, equals), true);
    if (pair.empty() || name == "token") continue;
    const auto said = std::find_if(given.begin(), given.end(), [&](const Member& m) { return m.name == name; });
    if (said != given.end()) {
      return fail(ErrorCode::InvalidParams, fmt::format("expected it in the path alone, which says \"{}\"", said->value),
                  "params." + name);
    }
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      return fail(ErrorCode::InvalidParams, "expected it once, found it again", "params." + name);
    }
    names.push_back(name);
    add(name, equals == std::string_view::npos ? std::string() : decoded(pair.substr(equals + 1), true));
  }
  // Strings, even where they look like numbers.
  for (const Member& m : given) {
    if (json.size() > 1) json += ',';
    protocol::append_json_string(m.name, json);
    json += ':';
    protocol::append_json_string(m.value, json);
  }
  return json + '}';
}

asio::awaitable<HttpResponse> answer_frame(const HttpRequest& request, const ScenePath& path, SessionContext& context) {
  const bool png = path.leaf == "frame.png";
  const auto params =
      query_params<commands::FrameParams>(request, {{"scene", path.scene}, {"format", png ? "png" : "jpeg"}}, context);
  if (!params) co_return refuse(request, params.error());
  const commands::Services& services = context.services;
  Result<streams::StillRequest> still = commands::still_request(*params, {services, services.stage.view(), steady_now_us()});
  if (!still) co_return refuse(request, still.error());

  const auto awaited = std::make_shared<Awaited>(co_await asio::this_coro::executor);
  const Status taken =
      services.stills.render(std::move(*still), [awaited, to_network = context.to_network](Result<streams::Still> done) {
        // Megabytes are copied here, on the worker.
        Result<std::string> file = std::string();
        if (done) {
          file->assign(reinterpret_cast<const char*>(done->file.data()), done->file.size());
        } else {
          file = done.error();
        }
        to_network([awaited, file = std::move(file)]() mutable {
          awaited->file = std::move(file);
          awaited->arrived.cancel();
        });
      });
  if (!taken) co_return refuse_for_now(request, taken.error(), kRetryPicture);
  while (!awaited->file) co_await awaited->arrived.async_wait(asio::as_tuple(asio::use_awaitable));
  if (!*awaited->file) co_return refuse(request, awaited->file->error());
  co_return http_answer(request, 200, png ? "image/png" : "image/jpeg", std::move(**awaited->file));
}

std::variant<commands::StreamOpenParams, HttpResponse> prepare_stream(const HttpRequest& request, const ScenePath& path,
                                                                      const SessionContext& context) {
  auto params = query_params<commands::StreamOpenParams>(request, {{"scene", path.scene}, {"kind", "frames"}}, context);
  if (!params) return refuse(request, params.error());
  const auto view = context.services.stage.view();
  if (const auto key = commands::stream_key(*params, *view, context.services); !key) return refuse(request, key.error());
  if (params->encoding.value_or(commands::StreamEncoding::Jpeg) != commands::StreamEncoding::Jpeg) {
    return refuse(request, fail(ErrorCode::InvalidParams, "expected jpeg, what this path is named for", "params.encoding"));
  }
  // Who reads pictures from a URL has said their size in it, and few players bear another one.
  params->adaptive = false;
  return std::move(*params);
}

asio::awaitable<void> run_picture_session(Tcp::socket socket, commands::StreamOpenParams params, SessionContext& context) {
  const auto connection = std::make_shared<Connection>(std::move(socket), Framing::Multipart, context.services.metrics);
  connection->begin(context.services, context.to_network, kEveryonesRole);
  const Registered registered(context, [&connection] { connection->end_soon(kFarewell); });
  connection->push_raw(
      fmt::format("HTTP/1.1 200 OK\r\nServer: tweend/{}\r\nContent-Type: {}\r\n"
                  "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n{}",
                  TWEEND_VERSION, kMultipartType, kMultipartBegin));
  commands::open_stream(params, connection->conversation().shared_from_this(),
                        [connection](const commands::ConnectionAnswer& answer) {
                          if (answer.afterwards) answer.afterwards();
                          // What it was to show has gone since it was looked at: the answer ends as it would then.
                          if (!answer.result) connection->close();
                        });
  // Nothing more is to come from the client: what is read tells that it has gone.
  std::array<char, 512> ignored;
  while (connection->open()) {
    const auto [error, bytes] =
        co_await connection->socket().async_read_some(asio::buffer(ignored), asio::as_tuple(asio::use_awaitable));
    if (error) break;
  }
  connection->close();
}

}  // namespace tweend::net
