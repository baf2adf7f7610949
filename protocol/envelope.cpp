#include "protocol/envelope.hpp"

#include <fmt/format.h>

#include "protocol/json_node.hpp"
#include "protocol/type_info.hpp"

namespace tweend::protocol {
namespace {

using nlohmann::json;

Rejected rejected(std::string id, ErrorCode code, std::string message, std::string path = {}) {
  return {std::move(id), fail(code, std::move(message), std::move(path))};
}

std::variant<Request, Rejected> parse_request(const JsonValue& whole, const json& j) {
  if (!j.is_object()) {
    return rejected("null", ErrorCode::InvalidRequest, fmt::format("expected a request object, found {}", describe_found(j)));
  }
  const auto id = j.find("id");
  if (id != j.end() && !id->is_string() && !id->is_number() && !id->is_null()) {
    return rejected("null", ErrorCode::InvalidRequest,
                    fmt::format("expected id to be a text, a number or null, found {}", describe_found(*id)));
  }
  const std::string id_text = id == j.end() ? std::string() : id->dump();
  const std::string answer_id = id_text.empty() ? "null" : id_text;

  const auto version = j.find("jsonrpc");
  if (version == j.end() || *version != "2.0") {
    return rejected(answer_id, ErrorCode::InvalidRequest, R"(expected "jsonrpc":"2.0" in the request)");
  }
  const auto method = j.find("method");
  if (method == j.end() || !method->is_string()) {
    return rejected(
        answer_id, ErrorCode::InvalidRequest,
        fmt::format("expected method to be a text, found {}", method == j.end() ? "none" : describe_found(*method)));
  }
  Request request{id_text, method->get<std::string>(), {}};
  if (const auto params = j.find("params"); params != j.end()) {
    if (params->is_array()) {
      // A valid request to JSON-RPC, so that as a notification it is not answered.
      return rejected(id_text, ErrorCode::InvalidParams,
                      "expected params to be an object with named parameters, found an array", "params");
    }
    if (!params->is_object()) {
      return rejected(answer_id, ErrorCode::InvalidRequest,
                      fmt::format("expected params to be an object, found {}", describe_found(*params)), "params");
    }
    request.params = part_of(whole, *params);
  }
  return request;
}

}  // namespace

Message parse_message(std::string_view text, const Limits& limits) {
  Message message;
  const Result<JsonValue> whole = JsonValue::parse(text, limits);
  if (!whole) {
    message.items.emplace_back(Rejected{"null", whole.error()});
    return message;
  }
  const json& j = json_of(*whole);
  if (!j.is_array()) {
    message.items.push_back(parse_request(*whole, j));
    return message;
  }
  if (j.empty() || j.size() > limits.batch_requests) {
    message.items.emplace_back(
        j.empty()
            ? rejected("null", ErrorCode::InvalidRequest, "expected at least one request in a batch, found none")
            : rejected("null", ErrorCode::Limit,
                       fmt::format("expected at most {} requests in a batch, found {}", limits.batch_requests, j.size())));
    return message;
  }
  message.batch = true;
  message.items.reserve(j.size());
  for (const json& item : j) message.items.push_back(parse_request(*whole, item));
  return message;
}

std::string answer_json(std::string_view id, std::string_view result) {
  return fmt::format(R"({{"jsonrpc":"2.0","id":{},"result":{}}})", id, result);
}

std::string error_json(const Error& error) {
  std::string text = fmt::format(R"({{"code":{},"message":)", wire_code(error.code));
  append_json_string(phrase(error.code), text);
  text += R"(,"data":{"kind":)";
  append_json_string(wire_kind(error.code), text);
  if (!error.path.empty()) {
    text += R"(,"path":)";
    append_json_string(error.path, text);
  }
  if (error.revision) text += fmt::format(R"(,"revision":{})", *error.revision);
  text += R"(,"message":)";
  append_json_string(error.message.empty() ? phrase(error.code) : std::string_view(error.message), text);
  text += "}}";
  return text;
}

std::string answer_json(std::string_view id, const Error& error) {
  return fmt::format(R"({{"jsonrpc":"2.0","id":{},"error":{}}})", id, error_json(error));
}

std::string notification_json(std::string_view method, std::string_view params) {
  return fmt::format(R"({{"jsonrpc":"2.0","method":"{}","params":{}}})", method, params);
}

}  // namespace tweend::protocol
