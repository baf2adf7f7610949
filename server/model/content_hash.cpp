#include "server/model/content_hash.hpp"

#include <fmt/format.h>
#include <xxhash.h>

namespace tweend::model {

ContentHash hash_bytes(std::span<const std::byte> bytes) noexcept {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.high64, hash.low64};
}

std::string to_string(const ContentHash& hash) { return fmt::format("{:016x}{:016x}", hash.high, hash.low); }

}  // namespace tweend::model
