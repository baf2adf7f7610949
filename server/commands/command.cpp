#include "server/commands/command.hpp"

#include <fmt/format.h>

#include <algorithm>
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
    const auto characters = [](const std::string& text) {  // of UTF-8: bytes that begin one
      return std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
    };
    if (target.retry_key && (target.retry_key->empty() || characters(*target.retry_key) > 64)) {
      return fail(ErrorCode::InvalidParams, fmt::format("expected 1 to 64 characters, found {}", characters(*target.retry_key)),
                  path + ".retry_key");
    }
  }
  return decoded;
}

}  // namespace tweend::commands
