#include "server/base/error.hpp"

#include <array>
#include <cstddef>

namespace tweend {
namespace {

struct Row {
  int code;
  std::string_view kind;
  std::string_view phrase;
};

constexpr std::array kRows{
#define TWEEND_ERROR(name, kind, code, phrase) Row{code, kind, phrase},
#include "server/base/error_codes.def"
#undef TWEEND_ERROR
};

const Row& row(ErrorCode code) noexcept { return kRows[static_cast<std::size_t>(code)]; }

}  // namespace

int wire_code(ErrorCode code) noexcept { return row(code).code; }
std::string_view wire_kind(ErrorCode code) noexcept { return row(code).kind; }
std::string_view phrase(ErrorCode code) noexcept { return row(code).phrase; }

}  // namespace tweend
