#include "protocol/json_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "protocol/json_node.hpp"

namespace tweend::protocol {
namespace {

// The parser recurses into nothing, but the document's destructor and every reader would: depth is bounded first.
std::size_t nesting_depth(std::string_view text) noexcept {
  std::size_t depth = 0, deepest = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    switch (text[i]) {
      case '"':  // skip the string
        for (++i; i < text.size() && text[i] != '"'; ++i) {
          if (text[i] == '\\') ++i;
        }
        break;
      case '[':
      case '{':
        deepest = std::max(deepest, ++depth);
        break;
      case ']':
      case '}':
        if (depth > 0) --depth;
        break;
      default:
        break;
    }
  }
  return deepest;
}

// nlohmann's sentence without its bracketed number: "parse error at line 1, column 2: …"
std::string reason(const nlohmann::json::exception& e) {
  const std::string_view what = e.what();
  const auto at = what.find("] ");
  std::string text(at == std::string_view::npos ? what : what.substr(at + 2));
  // It quotes the text as far as it was read, which may be half a character: an answer is UTF-8 whatever was asked.
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80; }, '?');
  return text;
}

}  // namespace

JsonValue::JsonValue() : json_(std::make_shared<const nlohmann::json>(nlohmann::json::object())) {}

Result<JsonValue> JsonValue::parse(std::string_view text, const Limits& limits) {
  if (const std::size_t depth = nesting_depth(text); depth > limits.json_depth) {
    return fail(ErrorCode::Limit, fmt::format("expected JSON nested at most {} deep, found {}", limits.json_depth, depth));
  }
  // nlohmann-json 3.11.2 takes a NUL for the end of the text.
  if (const auto nul = text.find('\0'); nul != std::string_view::npos) {
    return fail(ErrorCode::Parse, fmt::format("expected JSON, found a NUL byte at position {}", nul));
  }
  try {
    return JsonValue(std::make_shared<const nlohmann::json>(nlohmann::json::parse(text)));
  } catch (const nlohmann::json::exception& e) {
    return fail(ErrorCode::Parse, reason(e));
  }
}

std::string describe_found(const nlohmann::json& json) {
  switch (json.type()) {
    case nlohmann::json::value_t::null:
      return "null";
    case nlohmann::json::value_t::boolean:
      return json.get<bool>() ? "true" : "false";
    case nlohmann::json::value_t::string: {
      const auto& text = json.get_ref<const std::string&>();
      return text.size() <= 80 ? "\"" + text + "\"" : fmt::format("a text of {} bytes", text.size());
    }
    case nlohmann::json::value_t::array:
      return fmt::format("an array of {}", json.size());
    case nlohmann::json::value_t::object:
      return "an object";
    default:
      return json.dump();
  }
}

}  // namespace tweend::protocol
