#include "tests/render/support/image.hpp"

#include <gtest/gtest.h>
#include <spng.h>

#include <fstream>
#include <iterator>
#include <memory>

#include "render/image_encoder.hpp"

namespace tweend::render::test {

Image::Image(const ImageView& view) : Image(view.size) {
  for (std::size_t y = 0; y < size.height; ++y) {
    const auto row = view.row(y);
    for (std::size_t x = 0; x < size.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) rgb[3 * (y * size.width + x) + c] = static_cast<std::uint8_t>(row[4 * x + c]);
    }
  }
}

ImageView upside_down(const Image& image, std::vector<std::byte>& storage) {
  storage.assign(std::size_t{4} * image.size.width * image.size.height, std::byte{255});
  for (std::size_t y = 0; y < image.size.height; ++y) {
    for (std::size_t x = 0; x < image.size.width; ++x) {
      const Rgb color = image.at(x, y);
      std::byte* to = storage.data() + 4 * ((image.size.height - 1 - y) * image.size.width + x);
      for (std::size_t c = 0; c < 3; ++c) to[c] = static_cast<std::byte>(color[c]);
    }
  }
  return {image.size, storage};
}

Image decode_png(std::span<const std::byte> file) {
  const std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> context(spng_ctx_new(0), &spng_ctx_free);
  spng_ihdr header{};
  if (spng_set_png_buffer(context.get(), file.data(), file.size()) != 0 || spng_get_ihdr(context.get(), &header) != 0) {
    return {};
  }
  Image image(Size{header.width, header.height});
  if (spng_decode_image(context.get(), image.rgb.data(), image.rgb.size(), SPNG_FMT_RGB8, 0) != 0) return {};
  return image;
}

std::vector<std::byte> read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

void write_file(const std::string& path, std::span<const std::byte> bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  EXPECT_TRUE(file.good()) << path;
}

void write_png(const std::string& path, const Image& image) {
  std::vector<std::byte> storage;
  const auto file = encode_png(upside_down(image, storage));
  ASSERT_TRUE(file) << file.error().message;
  write_file(path, *file);
}

}  // namespace tweend::render::test
