#include "render/image_encoder.hpp"

#include <fmt/format.h>
#include <spng.h>
#include <turbojpeg.h>

#include <cstdlib>
#include <string_view>
#include <utility>

namespace tweend::render {

struct JpegEncoder::Impl {
  tjhandle handle = tjInitCompress();
  ~Impl() {
    if (handle != nullptr) tjDestroy(handle);
  }
};

JpegEncoder::JpegEncoder() : impl_(std::make_unique<Impl>()) {}
JpegEncoder::~JpegEncoder() = default;
JpegEncoder::JpegEncoder(JpegEncoder&&) noexcept = default;
JpegEncoder& JpegEncoder::operator=(JpegEncoder&&) noexcept = default;

std::size_t JpegEncoder::most_bytes(Size size) noexcept {
  return tjBufSize(static_cast<int>(size.width), static_cast<int>(size.height), TJSAMP_420);
}

Result<std::size_t> JpegEncoder::encode(const ImageView& image, int quality, std::span<std::byte> out) {
  const auto failed = [&](std::string_view reason) {
    return fail(ErrorCode::Internal,
                fmt::format("expected a JPEG of {} x {} pixels, found: {}", image.size.width, image.size.height, reason));
  };
  if (image.size.width == 0 || image.size.height == 0) return failed("no pixels");
  // libjpeg-turbo 2 does not look at how much room it is given: it takes for granted what tjBufSize says.
  if (out.size() < most_bytes(image.size)) {
    return failed(fmt::format("room for {} bytes where it may take {}", out.size(), most_bytes(image.size)));
  }
  auto* begin = reinterpret_cast<unsigned char*>(out.data());
  auto bytes = static_cast<unsigned long>(out.size());
  const auto* pixels = reinterpret_cast<const unsigned char*>(image.bytes.data());
  // Bottom-up rows are read as they lie: nothing is flipped.
  const int error = tjCompress2(impl_->handle, pixels, static_cast<int>(image.size.width), static_cast<int>(image.row_bytes()),
                                static_cast<int>(image.size.height), TJPF_RGBX, &begin, &bytes, TJSAMP_420, quality,
                                TJFLAG_BOTTOMUP | TJFLAG_NOREALLOC);
  if (error == 0) return static_cast<std::size_t>(bytes);
  return failed(tjGetErrorStr2(impl_->handle));
}

namespace {

struct SpngDeleter {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};

/// One row after the other, from the top, each without its alpha.
int encode_rows(spng_ctx* context, const ImageView& image) {
  std::vector<std::byte> rgb(std::size_t{3} * image.size.width);
  int error = SPNG_OK;
  for (std::size_t y = 0; y < image.size.height && error == SPNG_OK; ++y) {
    const auto rgba = image.row(y);
    for (std::size_t x = 0; x < image.size.width; ++x) {
      rgb[3 * x] = rgba[4 * x];
      rgb[3 * x + 1] = rgba[4 * x + 1];
      rgb[3 * x + 2] = rgba[4 * x + 2];
    }
    error = spng_encode_row(context, rgb.data(), rgb.size());
  }
  return error == SPNG_EOI ? SPNG_OK : error;
}

}  // namespace

Result<std::vector<std::byte>> encode_jpeg(const ImageView& image, int quality) {
  std::vector<std::byte> file(JpegEncoder::most_bytes(image.size));
  TWEEND_ASSIGN(const std::size_t bytes, JpegEncoder().encode(image, quality, file));
  file.resize(bytes);
  return file;
}

Result<std::vector<std::byte>> encode_png(const ImageView& image) {
  const std::unique_ptr<spng_ctx, SpngDeleter> context(spng_ctx_new(SPNG_CTX_ENCODER));
  const auto failed = [&](int error) {
    return fail(ErrorCode::Internal, fmt::format("expected a PNG of {} x {} pixels, found: {}", image.size.width,
                                                 image.size.height, spng_strerror(error)));
  };
  if (!context) return failed(SPNG_EMEM);
  // Fast rather than small: a picture is looked at once. The Up filter catches what rows have in common.
  constexpr int kLevel = 3;
  spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_set_option(context.get(), SPNG_IMG_COMPRESSION_LEVEL, kLevel);
  spng_set_option(context.get(), SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_UP);
  spng_ihdr header{};
  header.width = image.size.width;
  header.height = image.size.height;
  header.bit_depth = 8;
  header.color_type = SPNG_COLOR_TYPE_TRUECOLOR;
  if (const int error = spng_set_ihdr(context.get(), &header); error != SPNG_OK) return failed(error);
  if (const int error = spng_set_srgb(context.get(), 0); error != SPNG_OK) return failed(error);
  int error = spng_encode_image(context.get(), nullptr, 0, SPNG_FMT_PNG, SPNG_ENCODE_PROGRESSIVE | SPNG_ENCODE_FINALIZE);
  if (error == SPNG_OK) error = encode_rows(context.get(), image);
  if (error != SPNG_OK) return failed(error);
  std::size_t size = 0;
  const std::unique_ptr<void, decltype(&std::free)> file(spng_get_png_buffer(context.get(), &size, &error), &std::free);
  if (!file || error != SPNG_OK) return failed(error);
  const auto* bytes = static_cast<const std::byte*>(file.get());
  return std::vector<std::byte>(bytes, bytes + size);
}

}  // namespace tweend::render
