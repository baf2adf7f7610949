#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "clients/cli/json.hpp"
#include "protocol/packet.hpp"

namespace tweend::cli::test {

/// What a fake server does once it has read a request: writes `bytes`, then perhaps closes.
struct Reaction {
  std::string method;  ///< expected
  Json params;         ///< expected
  std::string bytes;   ///< `$ID` stands for the id of the request
  bool closes = false;
  std::function<void()> before = {};  ///< is done before anything is written
};

/// A server for one connection on a free port that plays a script: each request must be the one expected next.
/// What was not as expected is in complaints().
class FakeServer {
 public:
  explicit FakeServer(std::vector<Reaction> script);
  ~FakeServer();
  FakeServer(const FakeServer&) = delete;
  FakeServer& operator=(const FakeServer&) = delete;

  /// 127.0.0.1:PORT
  [[nodiscard]] const std::string& address() const noexcept { return address_; }
  /// Waits until the client has gone. Empty: every request of the script came, and nothing else.
  [[nodiscard]] std::string complaints();

 private:
  struct Asio;
  std::string address_;
  std::unique_ptr<Asio> asio_;
};

/// A port that is taken, but where nobody listens.
class DeafPort {
 public:
  DeafPort();
  ~DeafPort();
  DeafPort(const DeafPort&) = delete;
  DeafPort& operator=(const DeafPort&) = delete;
  [[nodiscard]] const std::string& address() const noexcept { return address_; }

 private:
  struct Asio;
  std::string address_;
  std::unique_ptr<Asio> asio_;
};

/// The line that answers with a result, or with an error.
[[nodiscard]] std::string answer(const Json& result);
[[nodiscard]] std::string refusal(const Json& error);
/// The line of an event.
[[nodiscard]] std::string event(std::string_view method, const Json& params);
/// An announcement with its packet, as on the wire. payload_bytes is filled in.
[[nodiscard]] std::string packet(protocol::PacketHeader header, const std::vector<float>& floats);
/// The same with any payload.
[[nodiscard]] std::string raw_packet(protocol::PacketHeader header, const std::string& payload);

/// A reaction that only answers.
[[nodiscard]] Reaction answers(std::string method, Json params, const Json& result);

}  // namespace tweend::cli::test
