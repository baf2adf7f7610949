#include "server/streams/rungs.hpp"

#include <gtest/gtest.h>

namespace tweend::streams {
namespace {

TEST(Rungs, TheTopIsWhatWasAskedFor) {
  EXPECT_EQ(size_on_rung({1280, 720}, 0), (render::Size{1280, 720}));
  EXPECT_EQ(quality_on_rung(80, 0), 80);
}

TEST(Rungs, EachIsSmallerOrPlainerThanTheOneAboveAndNoneIsLargerOrBetter) {
  for (std::size_t rung = 1; rung < kRungs.size(); ++rung) {
    const render::Size above = size_on_rung({1280, 720}, rung - 1), size = size_on_rung({1280, 720}, rung);
    const int quality_above = quality_on_rung(80, rung - 1), quality = quality_on_rung(80, rung);
    EXPECT_LE(size.width, above.width);
    EXPECT_LE(size.height, above.height);
    EXPECT_LE(quality, quality_above);
    EXPECT_TRUE(size.width < above.width || quality < quality_above) << rung;
  }
}

TEST(Rungs, KeepTheShapeAndAtLeastAPixelAndAQuality) {
  for (std::size_t rung = 0; rung < kRungs.size(); ++rung) {
    EXPECT_EQ(size_on_rung({1, 1}, rung), (render::Size{1, 1}));
    EXPECT_GE(quality_on_rung(1, rung), 1);
    const render::Size size = size_on_rung({1920, 1080}, rung);
    EXPECT_NEAR(static_cast<double>(size.width) / size.height, 1920.0 / 1080.0, 0.01);
  }
}

}  // namespace
}  // namespace tweend::streams
