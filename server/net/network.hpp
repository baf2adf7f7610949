#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "server/base/result.hpp"
#include "server/base/worker_pool.hpp"
#include "server/commands/services.hpp"
#include "server/net/web_files.hpp"

namespace tweend::net {

struct Endpoint {
  std::string address;  ///< "127.0.0.1" or "::1"
  std::uint16_t port = 0;
};

/// `ADDR:PORT`, `[ADDR]:PORT`; names other than localhost are not looked up.
/// @return InvalidParams saying what was expected
[[nodiscard]] Result<Endpoint> parse_endpoint(const std::string& text);

struct NetworkOptions {
  Endpoint listen{"127.0.0.1", 8933};
  std::vector<std::string> allowed_origins;
  WebFiles web = {};  ///< the page at /; empty: a welcome in plain text
};

/// The port and everything that comes in by it, on one thread: connections are judged by their first bytes and become line
/// JSON, HTTP or WebSocket sessions.
class Network {
 public:
  Network();
  ~Network();  ///< stop()
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// Posts to the network thread; good from construction until destruction.
  [[nodiscard]] Post post() const;

  /// Listens, then starts the thread. @return Unavailable naming the address and why it can't be had
  [[nodiscard]] Status start(const NetworkOptions& options, const commands::Services& services);
  /// Where it listens, once started: the port that the system picked if it was 0.
  [[nodiscard]] const Endpoint& endpoint() const noexcept;

  /// Closes the door, answers what has been asked, closes all connections (after 2 s at most), joins the thread.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tweend::net
