#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tweend {

/// What went wrong, as the wire knows it (docs/PROTOCOL.md, section 2).
enum class ErrorCode : std::uint8_t {
#define TWEEND_ERROR(name, kind, code, phrase) name,
#include "server/base/error_codes.def"
#undef TWEEND_ERROR
};

/// The JSON-RPC code, e.g. -32602.
[[nodiscard]] int wire_code(ErrorCode code) noexcept;
/// `data.kind`, e.g. "invalid_params".
[[nodiscard]] std::string_view wire_kind(ErrorCode code) noexcept;
/// One general sentence; `Error::message` says what happened this time.
[[nodiscard]] std::string_view phrase(ErrorCode code) noexcept;

/// Why something a person asked for was not done. After an error nothing has changed.
struct Error {
  ErrorCode code = ErrorCode::Internal;
  std::string message;                    ///< what was expected, what was found, where, what to do
  std::string path;                       ///< the offending parameter, e.g. "params.time"; empty: none
  std::optional<std::uint64_t> revision;  ///< a refused base_revision: where the scene stands

  bool operator==(const Error&) const = default;
};

}  // namespace tweend
