#include "render/image_encoder.hpp"

#include <gtest/gtest.h>
#include <spng.h>
#include <turbojpeg.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include "tests/render/support/image.hpp"

namespace tweend::render {
namespace {

using test::Image;

constexpr std::array<Size, 7> kSizes{{{1, 1}, {1, 9}, {9, 1}, {3, 5}, {16, 16}, {33, 17}, {320, 180}}};

Image noise(Size size) {
  std::mt19937 random(size.width);
  Image image(size);
  for (auto& value : image.rgb) value = static_cast<std::uint8_t>(random());
  return image;
}

/// Soft colours, and a top that differs from the bottom as the left does from the right.
Image slope(Size size) {
  Image image(size);
  for (std::size_t y = 0; y < size.height; ++y) {
    for (std::size_t x = 0; x < size.width; ++x) {
      image.set(x, y, {static_cast<int>(255 * x / 320), static_cast<int>(255 * y / 180), 60});
    }
  }
  return image;
}

std::vector<std::byte> encode_jpeg(const Image& image, int quality) {
  std::vector<std::byte> storage, file(JpegEncoder::most_bytes(image.size));
  JpegEncoder encoder;
  const auto size = encoder.encode(upside_down(image, storage), quality, file);
  EXPECT_TRUE(size) << size.error().message;
  file.resize(size ? *size : 0);
  return file;
}

Image decode_jpeg(const std::vector<std::byte>& file) {
  const std::unique_ptr<void, decltype(&tjDestroy)> decoder(tjInitDecompress(), &tjDestroy);
  const auto* bytes = reinterpret_cast<const unsigned char*>(file.data());
  int width = 0, height = 0, sampling = 0, space = 0;
  EXPECT_EQ(tjDecompressHeader3(decoder.get(), bytes, file.size(), &width, &height, &sampling, &space), 0);
  EXPECT_EQ(sampling, TJSAMP_420);
  Image image(Size{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)});
  EXPECT_EQ(tjDecompress2(decoder.get(), bytes, file.size(), image.rgb.data(), width, 0, height, TJPF_RGB, 0), 0);
  return image;
}

double mean_difference(const Image& a, const Image& b) {
  EXPECT_EQ(a.size, b.size);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(int{a.rgb[i]} - int{b.rgb[i]});
  return sum / static_cast<double>(a.rgb.size());
}

TEST(EncodePng, RefusesAPictureWithoutPixels) {
  const auto none = encode_png({{0, 5}, {}});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::Internal);
  EXPECT_NE(none.error().message.find("0 x 5"), std::string::npos) << none.error().message;
}

TEST(EncodePng, KeepsEveryPixelWithTheTopRowFirst) {
  for (const Size size : kSizes) {
    const Image image = noise(size);
    std::vector<std::byte> storage;
    const auto file = encode_png(upside_down(image, storage));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(test::decode_png(*file), image) << size.width << " x " << size.height;
  }
}

TEST(EncodePng, IsRgbOf8BitsTaggedSrgb) {
  std::vector<std::byte> storage;
  const auto file = encode_png(upside_down(noise({7, 3}), storage));
  ASSERT_TRUE(file);
  const std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> context(spng_ctx_new(0), &spng_ctx_free);
  spng_ihdr header{};
  std::uint8_t intent = 77;
  ASSERT_EQ(spng_set_png_buffer(context.get(), file->data(), file->size()), 0);
  ASSERT_EQ(spng_get_ihdr(context.get(), &header), 0);
  EXPECT_EQ(header.color_type, SPNG_COLOR_TYPE_TRUECOLOR);
  EXPECT_EQ(header.bit_depth, 8);
  EXPECT_EQ(spng_get_srgb(context.get(), &intent), 0) << "it has the chunk";
  EXPECT_EQ(intent, 0) << "perceptual";
}

TEST(EncodePng, DoesNotLookAtAlpha) {
  const Image image = noise({5, 4});
  std::vector<std::byte> storage;
  const ImageView view = upside_down(image, storage);
  for (std::size_t i = 3; i < storage.size(); i += 4) storage[i] = std::byte{0};
  EXPECT_EQ(test::decode_png(*encode_png(view)), image);
}

TEST(JpegEncoder, RefusesTooLittleRoomAndWritesNoFurther) {
  const Image image = noise({64, 48});
  std::vector<std::byte> storage;
  const ImageView view = upside_down(image, storage);
  const std::size_t most = JpegEncoder::most_bytes(image.size);
  JpegEncoder encoder;
  for (const std::size_t room : {std::size_t{0}, std::size_t{1}, std::size_t{100}, std::size_t{700}, most - 1}) {
    std::vector<std::byte> out(most + 4096, std::byte{77});
    const auto size = encoder.encode(view, 100, std::span(out).first(room));
    ASSERT_FALSE(size) << room;
    EXPECT_EQ(size.error().code, ErrorCode::Internal);
    for (std::size_t i = room; i < out.size(); ++i) ASSERT_EQ(out[i], std::byte{77}) << "wrote past " << room;
  }
  std::vector<std::byte> enough(most);
  EXPECT_TRUE(encoder.encode(view, 100, enough)) << "and goes on afterwards";
}

TEST(JpegEncoder, RefusesAPictureWithoutPixelsAndAQualityThatIsNone) {
  JpegEncoder encoder;
  std::vector<std::byte> out(4096), storage;
  EXPECT_FALSE(encoder.encode({{0, 5}, {}}, 90, out));
  EXPECT_FALSE(encoder.encode(upside_down(noise({4, 4}), storage), 101, out));
}

TEST(JpegEncoder, ShowsNearlyTheSameTheRightWayUp) {
  for (const Size size : kSizes) {
    const Image image = slope(size);
    EXPECT_LT(mean_difference(decode_jpeg(encode_jpeg(image, 90)), image), 3.0) << size.width << " x " << size.height;
  }
}

TEST(JpegEncoder, AHigherQualityIsLargerAndCloser) {
  const Image image = noise({64, 64});
  std::size_t last_size = 0;
  double last_difference = 256.0;
  for (const int quality : {10, 40, 70, 90, 100}) {
    const auto file = encode_jpeg(image, quality);
    EXPECT_GT(file.size(), last_size) << quality;
    last_size = file.size();
    const double difference = mean_difference(decode_jpeg(file), image);
    EXPECT_LT(difference, last_difference) << quality;
    last_difference = difference;
  }
}

TEST(JpegEncoder, EvenNoiseFitsIntoMostBytes) {
  for (const Size size : kSizes) EXPECT_LE(encode_jpeg(noise(size), 100).size(), JpegEncoder::most_bytes(size));
}

TEST(JpegEncoder, CanBeMovedAndUsedAgain) {
  JpegEncoder first;
  JpegEncoder second = std::move(first);
  std::vector<std::byte> storage, a(JpegEncoder::most_bytes({8, 8})), b(a.size());
  const ImageView view = upside_down(slope({8, 8}), storage);
  const auto once = second.encode(view, 80, a);
  const auto again = second.encode(view, 80, b);
  ASSERT_TRUE(once && again);
  EXPECT_EQ(*once, *again);
  EXPECT_EQ(a, b);
}

}  // namespace
}  // namespace tweend::render
