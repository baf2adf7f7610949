#include "server/app/serve.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include <boost/asio/ip/address.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <thread>
#include <utility>

#include "server/app/engine.hpp"
#include "server/app/loader.hpp"
#include "server/app/page.hpp"
#include "server/base/log.hpp"

namespace tweend::app {
namespace {

namespace fs = std::filesystem;

/// The signals that end the server, blocked in every thread and waited for in main's.
sigset_t block_ending_signals() {
  sigset_t ending;
  sigemptyset(&ending);
  sigaddset(&ending, SIGTERM);
  sigaddset(&ending, SIGINT);
  pthread_sigmask(SIG_BLOCK, &ending, nullptr);
  std::signal(SIGPIPE, SIG_IGN);  // a socket tells by its error
  return ending;
}

// One descriptor for each connection: take what the system grants.
void raise_descriptor_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

/// The data folder while a server has it: a lock that goes with the process.
class DataFolder {
 public:
  DataFolder() = default;
  ~DataFolder() {
    if (lock_ >= 0) ::close(lock_);
  }
  DataFolder(const DataFolder&) = delete;
  DataFolder& operator=(const DataFolder&) = delete;

  Status open(const std::string& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    const std::string file = folder + "/lock";
    lock_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (lock_ < 0) {
      return fail(ErrorCode::Unavailable,
                  fmt::format("expected a data folder that can be written at {}, found: {}; choose another with --data DIR",
                              folder, std::strerror(errno)));
    }
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
      return fail(ErrorCode::Unavailable,
                  fmt::format("expected the data folder {} to be free, found another server at work on it", folder));
    }
    return {};
  }

 private:
  int lock_ = -1;
};

Status check_access(const ServeOptions& options, const net::Endpoint& endpoint) {
  if (!options.no_auth) {
    return fail(ErrorCode::Forbidden,
                "expected --no-auth: this version has no tokens yet, and serves everyone on loopback alike");
  }
  if (!boost::asio::ip::make_address(endpoint.address).is_loopback()) {
    return fail(ErrorCode::Forbidden,
                fmt::format("expected a loopback address with --no-auth, found {}: everyone there could do everything",
                            endpoint.address));
  }
  return {};
}

/// Whole or not at all: who waits for the file never reads half a number.
Status write_port_file(const std::string& file, std::uint16_t port) {
  if (file.empty()) return {};
  const std::string temporary = file + ".new";
  std::ofstream(temporary) << port << '\n';
  std::error_code error;
  fs::rename(temporary, file, error);
  if (!error) return {};
  return fail(ErrorCode::Unavailable,
              fmt::format("expected a file that can be written at {}, found: {}; choose another with --port-file FILE", file,
                          error.message()));
}

/// The port before the engine.
class Server {
 public:
  Server(const ServeOptions& options, std::vector<assets::AssetRoot> roots)
      : options_(options), engine_(options.limits, std::move(roots), options.render, metrics_, network_.post()) {}

  Status start(const net::Endpoint& endpoint) {
    const commands::Services& services = engine_.services();
    if (const auto& device = engine_.renderer().device()) {
      log::info("drawing with " + *device);
    } else if (engine_.renderer().wanted()) {
      log::warn("no pictures: " + device.error().message);
    }
    TWEEND_TRY(engine_.start());
    for (const std::string& asset : options_.load) TWEEND_TRY(load_asset(services, asset));
    if (options_.play) TWEEND_TRY(play_all(services));
    TWEEND_ASSIGN(net::WebFiles page, load_page(options_.web));
    TWEEND_TRY(network_.start({endpoint, options_.allowed_origins, std::move(page)}, services));
    return write_port_file(options_.port_file, network_.endpoint().port);
  }

  [[nodiscard]] const net::Endpoint& endpoint() const noexcept { return network_.endpoint(); }

  /// Answers what has been asked, then stops.
  void stop() {
    engine_.end_films();  // first: they may take longer than the network waits for answers
    network_.stop();
    engine_.stop();
  }

 private:
  const ServeOptions options_;
  Metrics metrics_;
  net::Network network_;
  Engine engine_;
};

Status run(const ServeOptions& options) {
  const sigset_t ending = block_ending_signals();
  raise_descriptor_limit();
  TWEEND_ASSIGN(const net::Endpoint endpoint, net::parse_endpoint(options.listen));
  TWEEND_TRY(check_access(options, endpoint));
  DataFolder data;
  if (!options.data.empty()) TWEEND_TRY(data.open(options.data));
  TWEEND_ASSIGN(std::vector<assets::AssetRoot> roots, open_roots(options.assets));
  Server server(options, std::move(roots));
  if (Status started = server.start(endpoint); !started) {
    server.stop();
    return started;
  }
  const std::string host = endpoint.address.find(':') == std::string::npos ? endpoint.address : "[" + endpoint.address + "]";
  std::cout << fmt::format("http://{}:{}/", host, server.endpoint().port) << std::endl;
  if (!options.data.empty())
    log::info(fmt::format("documents live in memory in this version; {} is kept free of other servers", options.data));
  int signal = 0;
  sigwait(&ending, &signal);
  log::info(fmt::format("{}: answering what has been asked, then stopping", ::strsignal(signal)));
  server.stop();
  return {};
}

}  // namespace

int serve(const ServeOptions& options) {
  const Status status = run(options);
  if (status) return 0;
  std::cerr << "tweend: " << status.error().message << '\n';
  return 1;
}

}  // namespace tweend::app
