#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tweend::net {

/// Why a request by a browser is refused (403), or empty: it may pass. A page of another site must not speak to this server
/// through its visitor's browser, neither openly (Origin) nor under a name that it has pointed at this machine (Host, DNS
/// rebinding).
/// @param origin   of a WebSocket or state-changing request; empty: none was sent
/// @param allowed  `--allow-origin`s, e.g. "https://studio.example"
[[nodiscard]] std::string refuse_origin(std::string_view host, const std::optional<std::string>& origin,
                                        const std::vector<std::string>& allowed);

}  // namespace tweend::net
