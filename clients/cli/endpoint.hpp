#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tweend::cli {

inline constexpr std::uint16_t kDefaultPort = 8933;

/// Where a server listens.
struct Endpoint {
  std::string host;  ///< a name or an address, IPv6 without brackets
  std::uint16_t port = kDefaultPort;
  bool operator==(const Endpoint&) const = default;
};

/// Reads `HOST:PORT`, `[IPv6]:PORT`, or either without the port. Throws Usage.
[[nodiscard]] Endpoint parse_endpoint(std::string_view text);

/// The way parse_endpoint() reads it.
[[nodiscard]] std::string to_string(const Endpoint& endpoint);

}  // namespace tweend::cli
