#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "server/base/limits.hpp"
#include "server/base/result.hpp"

namespace tweend::protocol {

/// A parsed JSON value, or a part of one; copies share the document. Immutable, safe from any thread.
class JsonValue {
 public:
  /// An empty object.
  JsonValue();
  /// @param json  a nlohmann::json: a type that this layer's sources alone know (json_node.hpp)
  explicit JsonValue(std::shared_ptr<const void> json) noexcept : json_(std::move(json)) {}

  /// @return Parse with the position and what was expected; Limit where the nesting is too deep (checked before
  ///         anything is built)
  [[nodiscard]] static Result<JsonValue> parse(std::string_view text, const Limits& limits);

  [[nodiscard]] const std::shared_ptr<const void>& json() const noexcept { return json_; }

 private:
  std::shared_ptr<const void> json_;
};

}  // namespace tweend::protocol
