#include "server/assets/texture_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace {

constexpr std::size_t kMaxPixels = 1U << 16U;

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

/// A PNG or JPEG file: it is read or refused.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tweend::Limits limits;
  limits.texture_pixels = kMaxPixels;
  const auto image = tweend::assets::read_texture({reinterpret_cast<const char*>(data), size}, "fuzz", limits);
  if (!image) {
    require(image.error().message.starts_with("fuzz: "));
    return 0;
  }
  const std::size_t pixels = std::size_t{(*image)->width()} * (*image)->height();
  require(pixels > 0 && pixels <= kMaxPixels && (*image)->rgba().size() == 4 * pixels);
  return 0;
}
