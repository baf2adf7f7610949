#include "server/assets/texture_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "tests/assets/must.hpp"
#include "tests/assets/sample_images.hpp"

using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::StartsWith;

namespace tweend::assets {
namespace {

/// Red, green / blue, half-transparent white.
const Pixels kFour{2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 128}};

Pixels plain(std::uint32_t width, std::uint32_t height, std::size_t channels) {
  return {width, height, std::vector<std::uint8_t>(channels * width * height, 100)};
}

Error error_of(std::string_view bytes, const Limits& limits = {}) {
  const auto image = read_texture(bytes, "a/t.png", limits);
  return image ? Error{} : image.error();
}

/// A block of exactly its size, so that AddressSanitizer sees a read of one byte too many.
Result<model::ImagePtr> read_first(const std::string& file, std::size_t bytes) {
  const auto copy = std::make_unique<char[]>(bytes);
  file.copy(copy.get(), bytes);
  return read_texture({copy.get(), bytes}, "t", Limits{});
}

TEST(ReadTexture, ReadsPngAsItIsTopRowFirst) {
  const model::ImagePtr image = must(read_texture(png_file(kFour), "t.png", Limits{}));
  EXPECT_EQ(image->width(), 2U);
  EXPECT_EQ(image->height(), 2U);
  EXPECT_THAT(image->rgba(), ElementsAreArray(kFour.bytes));
}

TEST(ReadTexture, ReadsEveryKindOfPng) {
  const auto first_pixel = [](const Pixels& pixels, const PngKind& kind) {
    const model::ImagePtr image = must(read_texture(png_file(pixels, kind), "t.png", Limits{}));
    return std::vector<std::uint8_t>(image->rgba().begin(), image->rgba().begin() + 4);
  };
  EXPECT_THAT(first_pixel({1, 1, {1, 2, 3}}, {SPNG_COLOR_TYPE_TRUECOLOR}), ElementsAre(1, 2, 3, 255));
  EXPECT_THAT(first_pixel({1, 1, {7}}, {SPNG_COLOR_TYPE_GRAYSCALE}), ElementsAre(7, 7, 7, 255));
  EXPECT_THAT(first_pixel({1, 1, {7, 9}}, {SPNG_COLOR_TYPE_GRAYSCALE_ALPHA}), ElementsAre(7, 7, 7, 9));
  EXPECT_THAT(first_pixel({1, 1, {0x80}}, {SPNG_COLOR_TYPE_GRAYSCALE, 1}), ElementsAre(255, 255, 255, 255));
  EXPECT_THAT(first_pixel({1, 1, {1}}, {SPNG_COLOR_TYPE_INDEXED, 8, {{0, 0, 0, 0}, {5, 6, 7, 0}}}), ElementsAre(5, 6, 7, 255));
  const Pixels deep{1, 1, {0, 10, 0, 20, 0, 30}};  // 16 bits in the machine's order: only the high byte counts
  EXPECT_THAT(first_pixel(deep, {SPNG_COLOR_TYPE_TRUECOLOR, 16}), ElementsAre(10, 20, 30, 255));
}

TEST(ReadTexture, ReadsJpegAsItIsTopRowFirst) {
  for (const int flags : {0, TJFLAG_PROGRESSIVE}) {
    Pixels pixels = plain(16, 16, 3);
    for (std::size_t i = 0; i < pixels.bytes.size() / 2; ++i) pixels.bytes[i] = i % 3 == 0 ? 255 : 0;  // red above
    const model::ImagePtr image = must(read_texture(jpeg_file(pixels, flags), "t.jpg", Limits{}));
    EXPECT_EQ(image->width(), 16U);
    EXPECT_EQ(image->height(), 16U);
    const std::vector<std::uint8_t>& rgba = image->rgba();
    EXPECT_NEAR(rgba[0], 255, 4);
    EXPECT_NEAR(rgba[1], 0, 4);
    EXPECT_EQ(rgba[3], 255);
    EXPECT_NEAR(rgba[rgba.size() - 4], 100, 4);
  }
}

TEST(ReadTexture, TheSamePixelsHaveTheSameName) {
  const auto hash = [](const std::string& file) { return must(read_texture(file, "t", Limits{}))->hash(); };
  EXPECT_EQ(hash(png_file({1, 1, {1, 2, 3}}, {SPNG_COLOR_TYPE_TRUECOLOR})), hash(png_file({1, 1, {1, 2, 3, 255}})));
  EXPECT_NE(hash(png_file(plain(1, 4, 4))), hash(png_file(plain(4, 1, 4))));
}

TEST(ReadTexture, RefusesWhatIsNeither) {
  EXPECT_EQ(error_of("GIF89a..").message, "a/t.png: expected a PNG or JPEG image, found one that begins with \"GIF89a..\"");
  EXPECT_EQ(error_of("BM\x01 and more").message,
            "a/t.png: expected a PNG or JPEG image, found one that begins with \"BM\\x01 and \"");
  EXPECT_EQ(error_of("").message, "a/t.png: expected a PNG or JPEG image, found one that begins with \"\"");
  EXPECT_EQ(error_of("").code, ErrorCode::BadAsset);
}

TEST(ReadTexture, SaysWhatTheLibraryFound) {
  std::string png = png_file(kFour);
  png[png.size() - 20] ^= 1;  // within the pixels
  EXPECT_EQ(error_of(png).code, ErrorCode::BadAsset);
  EXPECT_THAT(error_of(png).message, StartsWith("a/t.png: expected a whole PNG image, found: "));
  const std::string jpeg = jpeg_file(plain(16, 16, 3));
  EXPECT_EQ(error_of(jpeg.substr(0, jpeg.size() - 2)).code, ErrorCode::BadAsset);
  EXPECT_THAT(error_of(jpeg.substr(0, jpeg.size() - 2)).message,
              testing::AllOf(StartsWith("a/t.png: expected a whole JPEG image, found: "), HasSubstr("end")));
}

TEST(ReadTexture, PixelsAreLimited) {
  Limits limits;
  limits.texture_pixels = 12;
  for (const bool jpeg : {false, true}) {
    const auto file = [&](std::uint32_t w, std::uint32_t h) {
      return jpeg ? jpeg_file(plain(w, h, 3)) : png_file(plain(w, h, 4));
    };
    EXPECT_TRUE(read_texture(file(4, 3), "t", limits));
    EXPECT_TRUE(read_texture(file(1, 12), "t", limits));
    const Error error = error_of(file(13, 1), limits);
    EXPECT_EQ(error.code, ErrorCode::Limit);
    EXPECT_EQ(error.message, "a/t.png: expected at most 12 pixels, found 13 x 1 = 13");
  }
}

TEST(ReadTexture, SidesAreLimited) {
  EXPECT_TRUE(read_texture(png_file(plain(16'384, 1, 4)), "t", Limits{}));
  for (const std::string& file :
       {png_file(plain(16'385, 1, 4)), png_file(plain(1, 16'385, 4)), jpeg_file(plain(16'385, 1, 3))}) {
    const Error error = error_of(file);
    EXPECT_EQ(error.code, ErrorCode::Limit);
    EXPECT_THAT(error.message, StartsWith("a/t.png: expected at most 16384 pixels a side, found "));
  }
}

TEST(ReadTexture, AHeaderThatClaimsMuchTakesNoMemory) {
  // Both are refused by the header, whatever follows; with 2^31 pixels a side the bytes would not even be countable.
  std::string png = png_file(kFour);
  for (const std::size_t i : {16U, 20U}) png[i] = '\x7F';
  EXPECT_NE(error_of(png).message, "");
  std::string jpeg = jpeg_file(plain(16, 16, 3));
  const std::size_t frame = jpeg.find("\xFF\xC0");
  for (std::size_t i = 5; i < 9; ++i) jpeg.at(frame + i) = '\xFF';
  EXPECT_NE(error_of(jpeg).message, "");
}

TEST(ReadTexture, NoTruncationIsTakenForWhole) {
  for (const PngKind& kind : {PngKind{}, PngKind{.interlaced = true}}) {
    const std::string png = png_file(kFour, kind);
    ASSERT_TRUE(read_first(png, png.size()));
    const std::size_t end = png.size() - 4;  // of the last chunk, which is empty, libspng needs no checksum
    for (std::size_t bytes = 0; bytes < end; ++bytes) EXPECT_FALSE(read_first(png, bytes)) << bytes;
  }
  for (const int flags : {0, TJFLAG_PROGRESSIVE}) {
    const std::string jpeg = jpeg_file(plain(16, 16, 3), flags);
    ASSERT_TRUE(read_first(jpeg, jpeg.size()));
    for (std::size_t bytes = 0; bytes < jpeg.size(); ++bytes) EXPECT_FALSE(read_first(jpeg, bytes)) << bytes;
  }
}

TEST(ReadTexture, EveryChangedByteIsReadOrRefused) {
  Limits limits;
  limits.texture_pixels = 1U << 16U;
  for (const std::string& file : {png_file(kFour), jpeg_file(plain(16, 16, 3), TJFLAG_PROGRESSIVE)}) {
    for (std::size_t i = 0; i < file.size(); ++i) {
      for (const char c : {'\0', '\x01', '\x7F', '\x80', '\xFF'}) {
        std::string changed = file;
        changed[i] = c;
        const auto image = read_texture(changed, "t", limits);
        if (image) {
          EXPECT_EQ((*image)->rgba().size(), std::size_t{4} * (*image)->width() * (*image)->height());
        } else {
          EXPECT_THAT(image.error().message, StartsWith("t: "));
        }
      }
    }
  }
}

}  // namespace
}  // namespace tweend::assets
