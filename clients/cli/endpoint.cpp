#include "clients/cli/endpoint.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "clients/cli/failure.hpp"

namespace tweend::cli {
namespace {

Usage malformed(std::string_view text, std::string_view why) {
  return Usage(fmt::format("expected a server as ADDR:PORT, found '{}': {}", text, why));
}

std::optional<std::uint16_t> parse_port(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error != std::errc{} || end != text.data() + text.size() || port == 0) return std::nullopt;
  return port;
}

}  // namespace

Endpoint parse_endpoint(std::string_view text) {
  std::string_view host = text;
  std::string_view port;
  if (text.starts_with('[')) {
    const auto close = text.find(']');
    if (close == std::string_view::npos) throw malformed(text, "a ']' is missing");
    host = text.substr(1, close - 1);
    port = text.substr(close + 1);
  } else if (const auto colon = text.find(':'); colon != std::string_view::npos) {
    if (text.find(':', colon + 1) != std::string_view::npos)
      throw malformed(text, "an IPv6 address stands in brackets, [::1]:8933");
    host = text.substr(0, colon);
    port = text.substr(colon);
  }
  if (host.empty()) throw malformed(text, "the address is missing");
  if (port.empty()) return {std::string(host), kDefaultPort};
  const auto number = port.starts_with(':') ? parse_port(port.substr(1)) : std::nullopt;
  if (!number) throw malformed(text, "a port is a number from 1 to 65535");
  return {std::string(host), *number};
}

std::string to_string(const Endpoint& endpoint) {
  const bool ipv6 = endpoint.host.find(':') != std::string::npos;
  return fmt::format(fmt::runtime(ipv6 ? "[{}]:{}" : "{}:{}"), endpoint.host, endpoint.port);
}

}  // namespace tweend::cli
