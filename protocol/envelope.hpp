#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/json_value.hpp"
#include "server/base/limits.hpp"
#include "server/base/result.hpp"

namespace tweend::protocol {

/// One JSON-RPC 2.0 request or notification, not yet validated against its method.
struct Request {
  std::string id;  ///< as JSON text ("7", "\"a\"", "null"); empty: a notification, which is not answered
  std::string method;
  JsonValue params;
};

/// Something that came in place of a request, and the error that answers it.
struct Rejected {
  std::string id = "null";
  Error error;
};

/// One message of a client: a single request, or a batch of them.
struct Message {
  bool batch = false;
  std::vector<std::variant<Request, Rejected>> items;
};

/// Splits a message into requests. What is malformed becomes a Rejected in its place, so that this never fails.
[[nodiscard]] Message parse_message(std::string_view text, const Limits& limits);

/// The whole JSON of an answer; `result` is JSON text.
[[nodiscard]] std::string answer_json(std::string_view id, std::string_view result);
[[nodiscard]] std::string answer_json(std::string_view id, const Error& error);
/// An error as an answer has it: code, message and data.
[[nodiscard]] std::string error_json(const Error& error);
/// `params` is JSON text.
[[nodiscard]] std::string notification_json(std::string_view method, std::string_view params);

}  // namespace tweend::protocol
