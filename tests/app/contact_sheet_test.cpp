#include "server/app/contact_sheet.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace tweend::app {
namespace {

constexpr render::Size kEach{5, 3};
constexpr std::uint32_t kGap = 2;

using Pixel = std::array<std::uint8_t, 4>;
constexpr Pixel kWhite{255, 255, 255, 255};

/// Every pixel of every picture is another one; y counts from the top.
Pixel pixel_of(std::size_t picture, std::size_t x, std::size_t y) {
  return {static_cast<std::uint8_t>(picture), static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 255};
}

std::vector<std::byte> picture(std::size_t index) {
  std::vector<std::byte> bytes(std::size_t{4} * kEach.width * kEach.height);
  for (std::size_t y = 0; y < kEach.height; ++y) {
    for (std::size_t x = 0; x < kEach.width; ++x) {
      const Pixel pixel = pixel_of(index, x, y);
      std::memcpy(&bytes[4 * ((kEach.height - 1 - y) * kEach.width + x)], pixel.data(), pixel.size());
    }
  }
  return bytes;
}

/// y counts from the top.
Pixel pixel_at(const render::ImageView& image, std::size_t x, std::size_t y) {
  Pixel pixel;
  std::memcpy(pixel.data(), image.row(y).data() + 4 * x, pixel.size());
  return pixel;
}

struct Grid {
  std::size_t count, columns, rows;
};

class AContactSheet : public testing::TestWithParam<Grid> {
 protected:
  [[nodiscard]] static std::uint32_t side(std::size_t pictures, std::uint32_t each) {
    return static_cast<std::uint32_t>(pictures) * each + static_cast<std::uint32_t>(pictures - 1) * kGap;
  }
};

TEST_P(AContactSheet, IsAsLargeAsItsPicturesAndTheGapsBetweenThem) {
  const ContactSheet sheet(kEach, GetParam().count);
  const render::Size whole{side(GetParam().columns, kEach.width), side(GetParam().rows, kEach.height)};
  EXPECT_EQ(sheet.size(), whole);
  EXPECT_EQ(sheet.view().size, whole);
  EXPECT_EQ(sheet.view().bytes.size(), std::size_t{4} * whole.width * whole.height);
}

TEST_P(AContactSheet, HasEveryPixelOfEachPictureInReadingOrderAndWhiteBetweenThem) {
  const auto [count, columns, rows] = GetParam();
  ContactSheet sheet(kEach, count);
  for (std::size_t i = count; i-- > 0;) {  // in any order
    const std::vector<std::byte> bytes = picture(i);
    sheet.put(i, {kEach, bytes});
  }
  for (std::size_t y = 0; y < sheet.size().height; ++y) {
    for (std::size_t x = 0; x < sheet.size().width; ++x) {
      const std::size_t column = x / (kEach.width + kGap), in_x = x % (kEach.width + kGap);
      const std::size_t row = y / (kEach.height + kGap), in_y = y % (kEach.height + kGap);
      const std::size_t index = row * columns + column;
      const bool inside = in_x < kEach.width && in_y < kEach.height && index < count;
      ASSERT_EQ(pixel_at(sheet.view(), x, y), inside ? pixel_of(index, in_x, in_y) : kWhite) << x << ", " << y;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, AContactSheet,
                         testing::Values(Grid{1, 1, 1}, Grid{2, 2, 1}, Grid{3, 3, 1}, Grid{4, 2, 2}, Grid{5, 3, 2},
                                         Grid{7, 3, 3}, Grid{9, 3, 3}, Grid{10, 4, 3}),
                         [](const testing::TestParamInfo<Grid>& grid) { return std::to_string(grid.param.count); });

TEST(ContactSheet, IsRefusedWhereItWouldBeLargerThanAnybodyCanLookAt) {
  EXPECT_TRUE(ContactSheet::check({1280, 720}, 100));
  const Status wide = ContactSheet::check({16'384, 16'384}, 64);
  ASSERT_FALSE(wide);
  EXPECT_EQ(wide.error().code, ErrorCode::Limit);
  EXPECT_FALSE(ContactSheet::check({4'294'967'295U, 1}, 4'000'000'000U));
  EXPECT_FALSE(ContactSheet::check({1, 4'294'967'295U}, 2));
}

}  // namespace
}  // namespace tweend::app
