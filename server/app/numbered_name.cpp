#include "server/app/numbered_name.hpp"

#include <fmt/format.h>

namespace tweend::app {

Result<std::string> numbered_name(const std::string& pattern, std::size_t number, bool several) {
  const auto refused = [&pattern](std::string_view found) {
    return fail(
        ErrorCode::InvalidParams,
        fmt::format("expected one %d (or %04d) in \"{}\", where the number of each picture goes, found {}", pattern, found));
  };
  std::string name;
  int numbers = 0;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '%') {
      name += pattern[i];
      continue;
    }
    std::size_t at = i + 1;
    const bool zeros = at < pattern.size() && pattern[at] == '0';
    if (zeros) ++at;
    int width = 0;
    if (at < pattern.size() && pattern[at] >= '1' && pattern[at] <= '9') width = pattern[at++] - '0';
    if (at < pattern.size() && pattern[at] == 'd') {
      name += zeros ? fmt::format("{:0{}}", number, width) : fmt::format("{:{}}", number, width);
      ++numbers;
    } else if (at == i + 1 && at < pattern.size() && pattern[at] == '%') {
      name += '%';
    } else {
      return refused("\"" + pattern.substr(i, at + 1 - i) + "\"");
    }
    i = at;
  }
  if (numbers > 1) return refused("several");
  if (several && numbers == 0) return refused("none");
  return name;
}

}  // namespace tweend::app
