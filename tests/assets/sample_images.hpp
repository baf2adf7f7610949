#pragma once

#include <spng.h>
#include <turbojpeg.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace tweend::assets {

/// Rows of whole pixels in one of libspng's layouts. What these make is by the libraries' own encoders.
struct Pixels {
  std::uint32_t width;
  std::uint32_t height;
  std::vector<std::uint8_t> bytes;
};

struct PngKind {
  std::uint8_t color_type = SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;
  std::uint8_t bit_depth = 8;
  std::vector<spng_plte_entry> palette = {};
  bool interlaced = false;
};

inline std::string png_file(const Pixels& pixels, const PngKind& kind = {}) {
  const std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> encoder(spng_ctx_new(SPNG_CTX_ENCODER), &spng_ctx_free);
  spng_set_option(encoder.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_ihdr header{pixels.width, pixels.height, kind.bit_depth, kind.color_type, 0, 0, 0};
  header.interlace_method = kind.interlaced ? SPNG_INTERLACE_ADAM7 : SPNG_INTERLACE_NONE;
  spng_set_ihdr(encoder.get(), &header);
  if (!kind.palette.empty()) {
    spng_plte palette{};
    for (const spng_plte_entry& entry : kind.palette) palette.entries[palette.n_entries++] = entry;
    spng_set_plte(encoder.get(), &palette);
  }
  int error = spng_encode_image(encoder.get(), pixels.bytes.data(), pixels.bytes.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
  std::size_t size = 0;
  const std::unique_ptr<void, decltype(&std::free)> file(spng_get_png_buffer(encoder.get(), &size, &error), &std::free);
  if (error != SPNG_OK) throw std::runtime_error(spng_strerror(error));
  return {static_cast<const char*>(file.get()), size};
}

/// Of RGB pixels, at the best quality and without thinning colours out.
inline std::string jpeg_file(const Pixels& pixels, int flags = 0) {
  const std::unique_ptr<void, decltype(&tjDestroy)> encoder(tjInitCompress(), &tjDestroy);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  const int error = tjCompress2(encoder.get(), pixels.bytes.data(), static_cast<int>(pixels.width), 0,
                                static_cast<int>(pixels.height), TJPF_RGB, &out, &size, TJSAMP_444, 100, flags);
  const std::unique_ptr<unsigned char, decltype(&tjFree)> file(out, &tjFree);
  if (error != 0) throw std::runtime_error(tjGetErrorStr2(encoder.get()));
  return {reinterpret_cast<const char*>(out), size};
}

}  // namespace tweend::assets
