#pragma once

#include <string>
#include <string_view>

#include "clients/cli/json.hpp"
#include "clients/cli/socket.hpp"

namespace tweend::cli {

class Session;

/// The next event; packets are skipped. Throws NoServer or TimedOut.
[[nodiscard]] Json next_event(Session& session, Deadline deadline);

/// A notification as an object. Throws NoServer if it is none.
[[nodiscard]] Json parse_event(const std::string& line);

/// The line for an event: words, or for programs `{"method":…,"params":…}`.
[[nodiscard]] std::string event_line(const Json& event, bool json);

/// Whether the event is about this actor; without a name every event is.
[[nodiscard]] bool concerns(const Json& event, std::string_view actor);

}  // namespace tweend::cli
