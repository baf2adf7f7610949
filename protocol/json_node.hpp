#pragma once

// For this layer's .cpp files only: the one place where nlohmann-json's type meets JsonValue.

#include <nlohmann/json.hpp>
#include <string>

#include "protocol/json_value.hpp"

namespace tweend::protocol {

[[nodiscard]] inline const nlohmann::json& json_of(const JsonValue& value) noexcept {
  return *static_cast<const nlohmann::json*>(value.json().get());
}

/// A part of `whole` that keeps the document alive; nothing is copied. `part` must belong to it.
[[nodiscard]] inline JsonValue part_of(const JsonValue& whole, const nlohmann::json& part) noexcept {
  return JsonValue(std::shared_ptr<const void>(whole.json(), &part));
}

/// "a number", "an array of 3", … for error messages.
[[nodiscard]] std::string describe_found(const nlohmann::json& json);

}  // namespace tweend::protocol
