#include "server/assets/texture_reader.hpp"

#include <fmt/format.h>
#include <spng.h>
#include <turbojpeg.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/assets/token.hpp"

namespace tweend::assets {
namespace {

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1A\n";
constexpr std::string_view kJpegSignature = "\xFF\xD8\xFF";
constexpr std::size_t kSignatureBytes = 8;
constexpr std::uint64_t kMaxSide = 16'384;              // what graphics processors commonly take
constexpr std::size_t kMaxChunkBytes = 16U << 20U;      // of a PNG's text or colour profile, packed or not
constexpr std::size_t kMaxAllChunksBytes = 64U << 20U;  // of all of them together

using PngDecoder = std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)>;
using JpegDecoder = std::unique_ptr<void, decltype(&tjDestroy)>;

Error unreadable(std::string_view name, std::string_view format, std::string_view reason) {
  return fail(ErrorCode::BadAsset, fmt::format("{}: expected a whole {} image, found: {}", name, format, reason));
}

Error out_of_memory(std::string_view name) {
  return fail(ErrorCode::Unavailable, fmt::format("{}: there is not enough memory to decode it", name));
}

Status check_size(std::uint64_t width, std::uint64_t height, std::string_view name, const Limits& limits) {
  if (width > kMaxSide || height > kMaxSide) {
    return fail(ErrorCode::Limit,
                fmt::format("{}: expected at most {} pixels a side, found {} x {}", name, kMaxSide, width, height));
  }
  if (width * height > limits.texture_pixels) {
    return fail(ErrorCode::Limit, fmt::format("{}: expected at most {} pixels, found {} x {} = {}", name, limits.texture_pixels,
                                              width, height, width * height));
  }
  return {};
}

Status png_status(int error, std::string_view name) {
  if (error == SPNG_OK) return {};
  if (error == SPNG_EMEM) return out_of_memory(name);
  return unreadable(name, "PNG", spng_strerror(error));
}

Result<model::ImagePtr> read_png(std::string_view bytes, std::string_view name, const Limits& limits) {
  const PngDecoder decoder(spng_ctx_new(0), &spng_ctx_free);
  if (!decoder) return out_of_memory(name);
  TWEEND_TRY(png_status(spng_set_chunk_limits(decoder.get(), kMaxChunkBytes, kMaxAllChunksBytes), name));
  TWEEND_TRY(png_status(spng_set_png_buffer(decoder.get(), bytes.data(), bytes.size()), name));
  spng_ihdr header{};
  TWEEND_TRY(png_status(spng_get_ihdr(decoder.get(), &header), name));
  TWEEND_TRY(check_size(header.width, header.height, name, limits));
  std::vector<std::uint8_t> rgba(std::size_t{4} * header.width * header.height);
  TWEEND_TRY(png_status(spng_decode_image(decoder.get(), rgba.data(), rgba.size(), SPNG_FMT_RGBA8, SPNG_DECODE_TRNS), name));
  // To the end, so that a file cut short after its last pixel isn't taken for whole either.
  TWEEND_TRY(png_status(spng_decode_chunks(decoder.get()), name));
  return model::Image::make(header.width, header.height, std::move(rgba));
}

Result<model::ImagePtr> read_jpeg(std::string_view bytes, std::string_view name, const Limits& limits) {
  const JpegDecoder decoder(tjInitDecompress(), &tjDestroy);
  if (!decoder) return out_of_memory(name);
  const auto* const data = reinterpret_cast<const unsigned char*>(bytes.data());
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int colorspace = 0;
  if (tjDecompressHeader3(decoder.get(), data, bytes.size(), &width, &height, &subsampling, &colorspace) != 0) {
    return unreadable(name, "JPEG", tjGetErrorStr2(decoder.get()));
  }
  TWEEND_TRY(check_size(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), name, limits));
  std::vector<std::uint8_t> rgba(std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  // The library merely warns of a file that ends early, and paints the rest grey. Thousands of scans make a small file slow.
  constexpr int kFlags = TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS;
  if (tjDecompress2(decoder.get(), data, bytes.size(), rgba.data(), width, 0, height, TJPF_RGBA, kFlags) != 0) {
    return unreadable(name, "JPEG", tjGetErrorStr2(decoder.get()));
  }
  return model::Image::make(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), std::move(rgba));
}

}  // namespace

Result<model::ImagePtr> read_texture(std::string_view bytes, std::string_view name, const Limits& limits) {
  if (bytes.starts_with(kPngSignature)) return read_png(bytes, name, limits);
  if (bytes.starts_with(kJpegSignature)) return read_jpeg(bytes, name, limits);
  return fail(ErrorCode::BadAsset, fmt::format("{}: expected a PNG or JPEG image, found one that begins with {}", name,
                                               quoted_token(bytes.substr(0, kSignatureBytes))));
}

}  // namespace tweend::assets
