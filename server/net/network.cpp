#include "server/net/network.hpp"

#include <fmt/format.h>

#include <array>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <charconv>
#include <string_view>
#include <thread>
#include <utility>

#include "server/base/log.hpp"
#include "server/net/http_session.hpp"
#include "server/net/line_session.hpp"

namespace tweend::net {
namespace {

namespace asio = boost::asio;

constexpr auto kAwait = asio::as_tuple(asio::use_awaitable);

enum class Spoken : std::uint8_t { Line, Http, Unknown };

/// What a connection is, by its first bytes (docs/PROTOCOL.md, section 1).
Spoken judge(std::string_view first) {
  constexpr std::string_view kLineStarts = "{[ \t\r\n\v\f";
  if (kLineStarts.find(first.front()) != std::string_view::npos) return Spoken::Line;
  constexpr std::array<std::string_view, 7> kMethods{"GET ", "HEAD ", "POST ", "PUT ", "DELETE ", "OPTIONS ", "PATCH "};
  for (const std::string_view method : kMethods) {
    // Slow clients send a letter at a time: the beginning of a method is good enough.
    const std::size_t shared = std::min(method.size(), first.size());
    if (method.substr(0, shared) == first.substr(0, shared)) return Spoken::Http;
  }
  return Spoken::Unknown;
}

/// Counts a connection for as long as it lives.
class Counted {
 public:
  explicit Counted(Metrics& metrics) : metrics_(metrics) {
    add(metrics_.connections);
    add(metrics_.connections_total);
  }
  ~Counted() { add(metrics_.connections, -1); }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  Metrics& metrics_;
};

/// Reads the first bytes, within their time. Empty: there were none.
asio::awaitable<std::string> read_first(boost::beast::tcp_stream& stream) {
  stream.expires_after(kFirstBytes);
  std::string first(4096, '\0');
  const auto [error, bytes] = co_await stream.async_read_some(asio::buffer(first), kAwait);
  first.resize(error ? 0 : bytes);
  co_return first;
}

asio::awaitable<void> run_connection(Tcp::socket accepted, SessionContext& context) {
  const Counted counted(context.services.metrics);
  boost::beast::tcp_stream stream(std::move(accepted));
  std::string first;
  {
    const Registered registered(context, [&stream] {
      boost::system::error_code ignored;
      stream.socket().shutdown(Tcp::socket::shutdown_receive, ignored);  // what has arrived is still read
    });
    first = co_await read_first(stream);
  }
  Tcp::socket socket = stream.release_socket();
  tune_socket(socket);
  add(context.services.metrics.bytes_received_total, static_cast<std::int64_t>(first.size()));
  const Spoken spoken = first.empty() ? Spoken::Unknown : judge(first);
  if (spoken == Spoken::Line) {
    co_await run_line_session(std::move(socket), std::move(first), context);
  } else if (spoken == Spoken::Http) {
    co_await run_http_session(std::move(socket), std::move(first), context);
  } else {
    add(context.services.metrics.connections_refused_total);
  }
}

}  // namespace

Result<Endpoint> parse_endpoint(const std::string& text) {
  const auto bad = [&] {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected ADDR:PORT, e.g. 127.0.0.1:8933 or [::1]:0, found \"{}\"", text));
  };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return bad();
  std::string address = text.substr(0, colon);
  if (address.starts_with('[') && address.ends_with(']')) address = address.substr(1, address.size() - 2);
  if (address == "localhost") address = "127.0.0.1";
  boost::system::error_code error;
  static_cast<void>(asio::ip::make_address(address, error));
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data() + colon + 1, end, port);
  if (error || parsed.ec != std::errc() || parsed.ptr != end) return bad();
  return Endpoint{address, port};
}

struct Network::Impl {
  std::unique_ptr<SessionContext> context;  // outlives the sessions, which go with io
  asio::io_context io{1};
  asio::executor_work_guard<asio::io_context::executor_type> work{io.get_executor()};
  Tcp::acceptor acceptor{io};
  Endpoint endpoint;
  std::thread thread;

  asio::awaitable<void> accept_loop() {
    Metrics& metrics = context->services.metrics;
    while (acceptor.is_open()) {
      auto [error, socket] = co_await acceptor.async_accept(kAwait);
      if (error == asio::error::operation_aborted) break;
      if (error) {  // out of descriptors, most likely: others may give some back
        log::warn(fmt::format("a connection could not be accepted: {}", error.message()));
        asio::steady_timer pause(io, std::chrono::milliseconds(100));
        co_await pause.async_wait(kAwait);
        continue;
      }
      if (static_cast<std::size_t>(metrics.connections.load()) >= context->services.limits.connections) {
        add(metrics.connections_refused_total);
        continue;
      }
      asio::co_spawn(io, run_connection(std::move(socket), *context), asio::detached);
    }
  }

  /// Runs on the network thread: no new connections, and those that are there end when all is said.
  asio::awaitable<void> drain() {
    context->stopping = true;
    boost::system::error_code ignored;
    acceptor.close(ignored);
    const auto sessions = context->sessions;  // ending one may change the set
    for (SessionContext::Ender* session : sessions) {
      if (context->sessions.contains(session)) session->end_soon();
    }
    const auto until = std::chrono::steady_clock::now() + kFarewell * 3 / 2;  // sessions end by themselves before
    asio::steady_timer pause(io);
    while (context->services.metrics.connections.load() > 0 && std::chrono::steady_clock::now() < until) {
      pause.expires_after(std::chrono::milliseconds(5));
      co_await pause.async_wait(kAwait);
    }
    io.stop();
  }
};

Network::Network() : impl_(std::make_unique<Impl>()) {}
Network::~Network() { stop(); }

Post Network::post() const {
  return [&io = impl_->io](Task task) { asio::post(io, std::move(task)); };
}

const Endpoint& Network::endpoint() const noexcept { return impl_->endpoint; }

Status Network::start(const NetworkOptions& options, const commands::Services& services) {
  impl_->context.reset(new SessionContext{services, post(), options.allowed_origins, false, {}});
  impl_->context->web = options.web;
  const Tcp::endpoint wanted(asio::ip::make_address(options.listen.address), options.listen.port);
  const auto failed = [&](const boost::system::error_code& error) {
    return fail(ErrorCode::Unavailable,
                fmt::format("expected to listen on {}:{}, found: {}; choose another with --listen ADDR:PORT",
                            options.listen.address, options.listen.port, error.message()));
  };
  boost::system::error_code error;
  impl_->acceptor.open(wanted.protocol(), error);
  if (error) return failed(error);
  impl_->acceptor.set_option(Tcp::acceptor::reuse_address(true), error);
  impl_->acceptor.bind(wanted, error);
  if (error) return failed(error);
  impl_->acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) return failed(error);
  impl_->endpoint = {options.listen.address, impl_->acceptor.local_endpoint().port()};
  asio::co_spawn(impl_->io, impl_->accept_loop(), asio::detached);
  impl_->thread = std::thread([this] { impl_->io.run(); });
  return {};
}

void Network::stop() {
  if (!impl_->thread.joinable()) return;
  asio::post(impl_->io, [this] { asio::co_spawn(impl_->io, impl_->drain(), asio::detached); });
  impl_->thread.join();
}

}  // namespace tweend::net
