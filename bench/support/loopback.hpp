#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tweend::bench {

/// A blocking socket to a port of this machine that sends at once what it is given. Gives up where nobody listens.
[[nodiscard]] int connect_loopback(std::uint16_t port);

/// What a line that announces a packet begins with.
inline constexpr std::string_view kAnnouncement = R"({"jsonrpc":"2.0","method":"stream.packet")";

/// How many bytes follow such a line, the packet's header among them. Gives up where it says none.
[[nodiscard]] std::size_t announced_bytes(std::string_view line);

}  // namespace tweend::bench
