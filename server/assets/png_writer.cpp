#include "server/assets/png_writer.hpp"

#include <fmt/format.h>
#include <spng.h>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

namespace tweend::assets {
namespace {

bool is_opaque(const std::vector<std::uint8_t>& rgba) {
  for (std::size_t i = 3; i < rgba.size(); i += 4) {
    if (rgba[i] != 0xFF) return false;
  }
  return true;
}

std::vector<std::uint8_t> without_alpha(const std::vector<std::uint8_t>& rgba) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < rgba.size(); i += 4) rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
  return rgb;
}

}  // namespace

Result<std::string> write_png(const model::Image& image) {
  const auto failed = [&](int error) {
    return fail(
        error == SPNG_EMEM ? ErrorCode::Unavailable : ErrorCode::Internal,
        fmt::format("expected a PNG of {} x {} pixels, found: {}", image.width(), image.height(), spng_strerror(error)));
  };
  const std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> encoder(spng_ctx_new(SPNG_CTX_ENCODER), &spng_ctx_free);
  if (!encoder) return failed(SPNG_EMEM);
  const bool opaque = is_opaque(image.rgba());
  spng_set_option(encoder.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_ihdr header{};
  header.width = image.width();
  header.height = image.height();
  header.bit_depth = 8;
  header.color_type = opaque ? SPNG_COLOR_TYPE_TRUECOLOR : SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;
  if (const int error = spng_set_ihdr(encoder.get(), &header); error != SPNG_OK) return failed(error);
  const std::vector<std::uint8_t> rgb = opaque ? without_alpha(image.rgba()) : std::vector<std::uint8_t>();
  const std::vector<std::uint8_t>& pixels = opaque ? rgb : image.rgba();
  int error = spng_encode_image(encoder.get(), pixels.data(), pixels.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
  if (error != SPNG_OK) return failed(error);
  std::size_t bytes = 0;
  const std::unique_ptr<void, decltype(&std::free)> file(spng_get_png_buffer(encoder.get(), &bytes, &error), &std::free);
  if (!file || error != SPNG_OK) return failed(error);
  return std::string(static_cast<const char*>(file.get()), bytes);
}

}  // namespace tweend::assets
