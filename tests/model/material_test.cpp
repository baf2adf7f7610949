#include "server/model/material.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace tweend::model {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(Image, RefusesBytesThatDoNotFitTheSize) {
  EXPECT_FALSE(Image::make(0, 0, {}));
  EXPECT_FALSE(Image::make(0, 1, {}));
  EXPECT_FALSE(Image::make(1, 0, {}));
  EXPECT_FALSE(Image::make(1, 1, {}));
  EXPECT_FALSE(Image::make(1, 1, Bytes(5)));
  const auto image = Image::make(2, 3, Bytes(23));
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().code, ErrorCode::InvalidParams);
  EXPECT_EQ(image.error().message, "expected 24 bytes of RGBA for 2 x 3 pixels (at least 1 x 1), found 23");
}

TEST(Image, KeepsWhatItWasGiven) {
  const auto image = Image::make(1, 2, {1, 2, 3, 4, 5, 6, 7, 8});
  ASSERT_TRUE(image);
  EXPECT_EQ((*image)->width(), 1U);
  EXPECT_EQ((*image)->height(), 2U);
  EXPECT_EQ((*image)->rgba(), (Bytes{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(Image, EqualContentHasEqualNames) {
  const auto hash = [](std::uint32_t width, std::uint32_t height, Bytes rgba) {
    return (*Image::make(width, height, std::move(rgba)))->hash();
  };
  EXPECT_EQ(hash(2, 1, Bytes(8)), hash(2, 1, Bytes(8)));
  EXPECT_NE(hash(2, 1, Bytes(8)), hash(1, 2, Bytes(8))) << "the shape is content too";
  EXPECT_NE(hash(1, 1, {0, 0, 0, 0}), hash(1, 1, {0, 0, 0, 1}));
}

TEST(Material, SaysNothingOfItsOwnByDefault) {
  const Material material;
  EXPECT_EQ(material.base_color, kDefaultBaseColor);
  EXPECT_EQ(material.base_color_texture, nullptr);
}

}  // namespace
}  // namespace tweend::model
