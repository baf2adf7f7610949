#include "server/net/same_origin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <boost/beast/core/string.hpp>

namespace tweend::net {
namespace {

using boost::beast::iequals;

/// "name:port" or "[v6]:port" without the port and brackets.
std::string_view host_name(std::string_view host) {
  if (host.starts_with('[')) {
    const auto end = host.find(']');
    const bool whole = end != std::string_view::npos && (end + 1 == host.size() || host[end + 1] == ':');
    return whole ? host.substr(1, end - 1) : host;
  }
  return host.substr(0, host.rfind(':'));
}

/// What follows "scheme://".
std::string_view origin_host(std::string_view origin) {
  const auto at = origin.find("://");
  return at == std::string_view::npos ? std::string_view() : origin.substr(at + 3);
}

bool is_address(std::string_view name) {
  boost::system::error_code error;
  static_cast<void>(boost::asio::ip::make_address(name, error));
  return !error;
}

}  // namespace

std::string refuse_origin(std::string_view host, const std::optional<std::string>& origin,
                          const std::vector<std::string>& allowed) {
  const std::string_view name = host_name(host);
  const bool known_host =
      is_address(name) || iequals(name, "localhost") || std::any_of(allowed.begin(), allowed.end(), [&](const std::string& a) {
        return iequals(origin_host(a), host) || iequals(host_name(origin_host(a)), name);
      });
  if (!known_host) {
    return fmt::format("expected Host to be an address, localhost or the host of an --allow-origin, found \"{}\"", host);
  }
  if (!origin) return {};
  const bool own = iequals(origin_host(*origin), host);
  const bool listed = std::any_of(allowed.begin(), allowed.end(), [&](const std::string& a) { return iequals(a, *origin); });
  if (own || listed) return {};
  return fmt::format("expected Origin to be this server's own or an --allow-origin, found \"{}\"", *origin);
}

}  // namespace tweend::net
