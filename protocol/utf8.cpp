#include "protocol/utf8.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace tweend::protocol {
namespace {

struct Lead {
  std::size_t following;  // continuation bytes
  unsigned char second_min, second_max;
};

// The second byte's range is what rules out overlong forms, surrogates and values past U+10FFFF (RFC 3629, section 4).
Lead classify(unsigned char lead) noexcept {
  if (lead >= 0xC2 && lead <= 0xDF) return {1, 0x80, 0xBF};
  if (lead == 0xE0) return {2, 0xA0, 0xBF};
  if (lead == 0xED) return {2, 0x80, 0x9F};
  if (lead >= 0xE1 && lead <= 0xEF) return {2, 0x80, 0xBF};
  if (lead == 0xF0) return {3, 0x90, 0xBF};
  if (lead >= 0xF1 && lead <= 0xF3) return {3, 0x80, 0xBF};
  if (lead == 0xF4) return {3, 0x80, 0x8F};
  return {0, 1, 0};
}

}  // namespace

bool is_utf8(std::string_view text) noexcept {
  const auto* at = reinterpret_cast<const unsigned char*>(text.data());
  const auto* end = at + text.size();
  while (at < end) {
    std::uint64_t eight = 0;  // JSON is nearly all ASCII: take it eight bytes at a time
    while (end - at >= 8) {
      std::memcpy(&eight, at, 8);
      if ((eight & 0x8080808080808080U) != 0) break;
      at += 8;
    }
    if (at == end) break;
    if (*at < 0x80) {
      ++at;
      continue;
    }
    const Lead lead = classify(*at);
    if (lead.following == 0 || static_cast<std::size_t>(end - at) <= lead.following) return false;
    if (at[1] < lead.second_min || at[1] > lead.second_max) return false;
    for (std::size_t i = 2; i <= lead.following; ++i) {
      if ((at[i] & 0xC0U) != 0x80U) return false;
    }
    at += lead.following + 1;
  }
  return true;
}

}  // namespace tweend::protocol
