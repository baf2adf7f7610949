#include "server/commands/command.hpp"

#include <fmt/format.h>

#include <array>

namespace tweend::commands {

std::string_view role_name(Role role) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"view", "control", "admin"};
  return kNames[static_cast<std::size_t>(role)];
}

Result<Params> decode_params(const Command& command, const protocol::JsonValue& params, const std::string& path) {
  Params decoded = command.make_params();
  TWEEND_TRY(protocol::decode(params, *command.params, decoded.get(), path));
  if (command.target != nullptr) {
    const EditTarget& target = command.target(decoded.get());
    if (target.retry_key && (target.retry_key->empty() || target.retry_key->size() > 64)) {
      return fail(ErrorCode::InvalidParams, fmt::format("expected 1 to 64 characters, found {}", target.retry_key->size()),
                  path + ".retry_key");
    }
  }
  return decoded;
}

}  // namespace tweend::commands
