#pragma once

#include <span>
#include <string>
#include <string_view>

#include "protocol/type_info.hpp"

namespace tweend::protocol {

/// What the outside may know of a method.
struct MethodInfo {
  std::string_view name;
  std::string_view role;  ///< "view", "control" or "admin"
  std::string_view summary;
  const TypeInfo* params = nullptr;
  const TypeInfo* result = nullptr;
};

/// The OpenRPC 1.3 document of all methods, as JSON text: a JSON Schema for each parameter and result, `x-role` for each
/// method.
[[nodiscard]] std::string openrpc_json(std::span<const MethodInfo> methods, std::string_view server_version);

}  // namespace tweend::protocol
