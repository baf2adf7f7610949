#include "tests/cli/fake_server.hpp"

#include <fmt/format.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

namespace tweend::cli::test {

namespace net = boost::asio;
using boost::system::error_code;
using net::ip::tcp;

struct FakeServer::Asio {
  std::vector<Reaction> script;
  std::string complaints;
  net::io_context io;
  tcp::acceptor acceptor{io, tcp::endpoint(net::ip::address_v4::loopback(), 0)};
  std::thread thread;

  void play(tcp::socket client) {
    std::string buffer;
    for (const Reaction& reaction : script) {
      const std::string line = read_line(client, buffer);
      if (line.empty()) return complain("the client left instead of asking for " + reaction.method);
      const Json request = Json::parse(line, nullptr, false);
      check(request, reaction);
      if (reaction.before) reaction.before();
      std::string bytes = reaction.bytes;
      const std::string id = request.is_object() ? request.value("id", Json()).dump() : "null";
      for (std::size_t at = 0; (at = bytes.find("$ID", at)) != std::string::npos;) bytes.replace(at, 3, id);
      error_code gone;
      net::write(client, net::buffer(bytes), gone);
      if (reaction.closes) return;
    }
    if (const auto more = read_line(client, buffer); !more.empty()) complain("not expected any more: " + more);
  }

  static std::string read_line(tcp::socket& client, std::string& buffer) {
    error_code gone;
    const std::size_t size = net::read_until(client, net::dynamic_buffer(buffer), '\n', gone);
    std::string line = buffer.substr(0, size);
    buffer.erase(0, size);
    return line;
  }

  /// nlohmann compares 1 and 1.0 as equal, and ordered_json the order of members: so both go through the unordered kind.
  void check(const Json& request, const Reaction& reaction) {
    const nlohmann::json expected = {
        {"jsonrpc", "2.0"}, {"method", reaction.method}, {"params", nlohmann::json(reaction.params)}};
    nlohmann::json found = nlohmann::json(request);
    if (!found.is_object() || !found.contains("id")) complain("a request without an id: " + request.dump());
    found.erase("id");
    if (found != expected) complain(fmt::format("expected {}\n   found {}", expected.dump(), found.dump()));
  }

  void complain(const std::string& what) { complaints += what + "\n"; }
};

FakeServer::FakeServer(std::vector<Reaction> script) : asio_(std::make_unique<Asio>()) {
  asio_->script = std::move(script);
  address_ = fmt::format("127.0.0.1:{}", asio_->acceptor.local_endpoint().port());
  asio_->acceptor.async_accept([this](error_code error, tcp::socket client) {
    asio_->acceptor.close();
    if (!error) asio_->play(std::move(client));
  });
  asio_->thread = std::thread([this] { asio_->io.run(); });
}

FakeServer::~FakeServer() {
  asio_->io.stop();  // if nobody has come
  if (asio_->thread.joinable()) asio_->thread.join();
}

std::string FakeServer::complaints() {
  if (asio_->thread.joinable()) asio_->thread.join();
  return asio_->complaints;
}

struct DeafPort::Asio {
  net::io_context io;
  tcp::socket socket{io, tcp::endpoint(net::ip::address_v4::loopback(), 0)};
};

DeafPort::DeafPort() : asio_(std::make_unique<Asio>()) {
  address_ = fmt::format("127.0.0.1:{}", asio_->socket.local_endpoint().port());
}

DeafPort::~DeafPort() = default;

std::string answer(const Json& result) {
  return fmt::format(R"({{"jsonrpc":"2.0","id":$ID,"result":{}}})", result.dump()) + "\n";
}

std::string refusal(const Json& error) {
  return fmt::format(R"({{"jsonrpc":"2.0","id":$ID,"error":{}}})", error.dump()) + "\n";
}

std::string event(std::string_view method, const Json& params) {
  return Json{{"jsonrpc", "2.0"}, {"method", method}, {"params", params}}.dump() + "\n";
}

std::string raw_packet(protocol::PacketHeader header, const std::string& payload) {
  header.payload_bytes = static_cast<std::uint32_t>(payload.size());
  const auto bytes = protocol::encode_header(header);
  const std::string head(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return event("stream.packet", {{"stream", header.stream}, {"bytes", head.size() + payload.size()}}) + head + payload;
}

std::string packet(protocol::PacketHeader header, const std::vector<float>& floats) {
  std::string payload(floats.size() * sizeof(float), '\0');
  if (!floats.empty()) std::memcpy(payload.data(), floats.data(), payload.size());
  return raw_packet(header, payload);
}

Reaction answers(std::string method, Json params, const Json& result) {
  return {std::move(method), std::move(params), answer(result)};
}

}  // namespace tweend::cli::test
