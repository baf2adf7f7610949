#include "server/assets/gltf_container.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "server/assets/asset_name.hpp"

namespace tweend::assets {
namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinChunk = 0x004E4942;

/// A little-endian number; the caller has made sure that it's there.
std::uint32_t read_u32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::uint32_t{static_cast<std::uint8_t>(bytes[at + i])} << (8 * i);
  return value;
}

class Chunks {
 public:
  Chunks(std::string_view bytes, std::string_view name) : bytes_(bytes), name_(name) {}

  Result<GltfContainer> read() {
    TWEEND_TRY(check_header());
    GltfContainer container;
    std::size_t at = kHeaderBytes;
    for (std::size_t number = 0; at < bytes_.size(); ++number) {
      if (bytes_.size() - at < kChunkHeaderBytes) {
        return refuse(at, fmt::format("expected a chunk's header of 8 bytes, found {} bytes", bytes_.size() - at));
      }
      const std::size_t length = read_u32(bytes_, at);
      const std::uint32_t type = read_u32(bytes_, at + 4);
      const std::size_t content = at + kChunkHeaderBytes;
      if (length % 4 != 0) return refuse(at, fmt::format("expected a chunk of a multiple of 4 bytes, found {}", length));
      if (length > bytes_.size() - content) {
        return refuse(at, fmt::format("expected a chunk of at most the {} bytes that are left, found one of {}",
                                      bytes_.size() - content, length));
      }
      TWEEND_TRY(take(container, number, at, type, bytes_.substr(content, length)));
      at = content + length;
    }
    if (container.json.data() == nullptr) return refuse(at, "expected a JSON chunk, found the end of the file");
    return container;
  }

 private:
  [[nodiscard]] Error refuse(std::size_t at, std::string_view message) const {
    return fail(ErrorCode::BadAsset, fmt::format("{} at byte {}: {}", quoted_name(name_), at, message));
  }

  [[nodiscard]] Status check_header() const {
    if (bytes_.size() < kHeaderBytes) {
      return refuse(0, fmt::format("expected a header of 12 bytes, found a file of {}", bytes_.size()));
    }
    if (const std::uint32_t version = read_u32(bytes_, 4); version != kVersion) {
      return refuse(4, fmt::format("expected version 2 of the binary format, found {}", version));
    }
    const std::size_t length = read_u32(bytes_, 8);
    if (length == bytes_.size()) return {};
    return refuse(8, fmt::format("expected a file of {} bytes as its header says, found {}{}", length, bytes_.size(),
                                 length > bytes_.size() ? ": it was cut short" : ""));
  }

  /// The JSON comes first and a binary chunk second; chunks of other types are for whoever knows them.
  [[nodiscard]] Status take(GltfContainer& container, std::size_t number, std::size_t at, std::uint32_t type,
                            std::string_view content) const {
    if ((number == 0) != (type == kJsonChunk)) {
      return refuse(at, number == 0 ? fmt::format("expected a JSON chunk first, found one of type {:#010x}", type)
                                    : std::string("expected one JSON chunk, found another"));
    }
    if (type == kJsonChunk) container.json = content;
    if (type != kBinChunk) return {};
    if (number != 1)
      return refuse(at, fmt::format("expected one binary chunk, second in the file, found it at place {}", number + 1));
    container.bin = content;
    return {};
  }

  std::string_view bytes_;
  std::string_view name_;
};

}  // namespace

Result<GltfContainer> open_gltf_container(std::string_view bytes, std::string_view name) {
  if (!bytes.starts_with(kMagic)) return GltfContainer{bytes, std::nullopt};
  return Chunks(bytes, name).read();
}

}  // namespace tweend::assets
