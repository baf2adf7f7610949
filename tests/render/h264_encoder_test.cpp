#include "render/h264_encoder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "render/h264_level.hpp"
#include "tests/render/support/film.hpp"

namespace tweend::render {
namespace {

using test::Film;
using test::Image;

constexpr Size kSize{192, 108};

std::vector<std::byte> encode(H264Encoder& encoder, const Image& image, bool key = false) {
  std::vector<std::byte> storage;
  const auto unit = encoder.encode(upside_down(image, storage), key);
  if (!unit) {
    ADD_FAILURE() << unit.error().message;
    return {};
  }
  return {unit->bytes.begin(), unit->bytes.end()};
}

H264Encoder open(const H264Options& options) {
  auto encoder = H264Encoder::open(options);
  EXPECT_TRUE(encoder) << encoder.error().message;
  return std::move(*encoder);
}

/// The units of an access unit: what follows each start code.
std::vector<std::vector<std::uint8_t>> nal_units(const std::vector<std::byte>& bytes) {
  std::vector<std::vector<std::uint8_t>> units;
  for (std::size_t i = 0; i < bytes.size();) {
    const auto starts = [&](std::size_t at) {
      return at + 3 <= bytes.size() && bytes[at] == std::byte{0} && bytes[at + 1] == std::byte{0} &&
             bytes[at + 2] == std::byte{1};
    };
    if (starts(i)) {
      units.emplace_back();
      i += 3;
      continue;
    }
    if (!units.empty()) units.back().push_back(static_cast<std::uint8_t>(bytes[i]));
    ++i;
  }
  return units;
}

constexpr int kIdr = 5, kSequenceSet = 7, kPictureSet = 8;

std::vector<int> types_of(const std::vector<std::byte>& bytes) {
  std::vector<int> types;
  for (const auto& unit : nal_units(bytes)) types.push_back(unit.at(0) & 31);
  return types;
}

TEST(H264Encoder, RefusesOddSidesNoPixelsAndTooMany) {
  for (const Size size : {Size{191, 108}, Size{192, 107}, Size{0, 108}, Size{192, 0}, Size{16'386, 16}, Size{16, 16'386}}) {
    const auto none = H264Encoder::open({.size = size});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::InvalidParams);
    EXPECT_NE(none.error().message.find(fmt::format("{} x {}", size.width, size.height)), std::string::npos);
  }
}

TEST(H264Encoder, RefusesARateThatIsNone) {
  for (const double rate : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_FALSE(H264Encoder::open({.size = kSize, .rate = rate}));
  }
}

TEST(H264Encoder, RefusesAPictureOfAnotherSizeAndGoesOn) {
  H264Encoder encoder = open({.size = kSize});
  std::vector<std::byte> storage;
  const auto none = encoder.encode(upside_down(test::moving_picture({194, 108}, 0), storage), false);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::InvalidParams);
  EXPECT_FALSE(encode(encoder, test::moving_picture(kSize, 0)).empty());
}

TEST(H264Encoder, GivesEachPictureAtOnceAndKeysOnlyWhereAskedFor) {
  H264Encoder encoder = open({.size = kSize});
  std::vector<std::byte> storage;
  std::vector<std::vector<std::byte>> units;
  // Past 250 pictures, where x264 of itself would make another key, and over a cut.
  for (std::size_t k = 0; k < 300; ++k) {
    Image image = test::moving_picture(kSize, k % 60);
    if (k == 200) std::fill(image.rgb.begin(), image.rgb.end(), std::uint8_t{255});
    const auto unit = encoder.encode(upside_down(image, storage), k == 7 || k == 8);
    ASSERT_TRUE(unit);
    EXPECT_EQ(unit->key, k == 0 || k == 7 || k == 8) << k;
    units.emplace_back(unit->bytes.begin(), unit->bytes.end());
  }
  const Film film = test::decode_h264(units);
  EXPECT_TRUE(film.complaints.empty()) << film.complaints.front();
  ASSERT_EQ(film.pictures.size(), 300U);
  for (std::size_t k = 0; k < 300; ++k) EXPECT_EQ(film.pictures[k].key, k == 0 || k == 7 || k == 8) << k;
}

TEST(H264Encoder, ShowsWhatItWasGivenTheRightWayUp) {
  for (const bool live : {true, false}) {
    H264Encoder encoder = open({.size = kSize, .live = live});
    std::vector<std::vector<std::byte>> units;
    for (std::size_t k = 0; k < 40; ++k) units.push_back(encode(encoder, test::moving_picture(kSize, k)));
    if (!live) units[0].insert(units[0].begin(), encoder.parameter_sets().begin(), encoder.parameter_sets().end());
    const Film film = test::decode_h264(units);
    ASSERT_EQ(film.pictures.size(), 40U);
    for (std::size_t k = 0; k < 40; ++k) {
      // Half the colour's resolution costs some of it at the square's edges.
      EXPECT_GT(test::psnr_db(film.pictures[k].image, test::moving_picture(kSize, k)), 33.0) << k;
      EXPECT_EQ(film.pictures[k].at, static_cast<std::int64_t>(k));
    }
  }
}

TEST(H264Encoder, KeepsFlatColoursToTheStepOfLimitedRange) {
  for (const test::Rgb& color : {test::Rgb{255, 255, 255}, {0, 0, 0}, {255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {51, 102, 204}}) {
    Image image(kSize);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = static_cast<std::uint8_t>(color[i % 3]);
    H264Encoder encoder = open({.size = kSize});
    const Film film = test::decode_h264({encode(encoder, image)});
    ASSERT_EQ(film.pictures.size(), 1U);
    for (const std::size_t x : {std::size_t{0}, std::size_t{100}, std::size_t{191}}) {
      const test::Rgb found = film.pictures[0].image.at(x, x / 2);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], color[c], 6) << c;
    }
  }
}

TEST(H264Encoder, AStreamBeginsAnewAtEachKey) {
  H264Encoder encoder = open({.size = kSize});
  std::vector<std::vector<std::byte>> units;
  for (std::size_t k = 0; k < 20; ++k) units.push_back(encode(encoder, test::moving_picture(kSize, k), k == 12));
  for (const std::size_t key : {std::size_t{0}, std::size_t{12}}) {
    const std::vector<int> types = types_of(units[key]);
    for (const int type : {kSequenceSet, kPictureSet, kIdr})
      EXPECT_NE(std::find(types.begin(), types.end(), type), types.end());
  }
  const Film whole = test::decode_h264(units);
  units.erase(units.begin(), units.begin() + 12);
  const Film late = test::decode_h264(units);
  EXPECT_TRUE(late.complaints.empty()) << late.complaints.front();
  ASSERT_EQ(late.pictures.size(), 8U);
  for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(late.pictures[k].image, whole.pictures[k + 12].image) << k;
}

TEST(H264Encoder, SaysOfItselfWhatCodecSays) {
  for (const auto& [size, rate] : {std::pair{Size{64, 64}, 30.0},
                                   {Size{720, 576}, 25.0},
                                   {Size{1280, 720}, 30.0},
                                   {Size{1280, 720}, 60.0},
                                   {Size{1920, 1080}, 60.0},
                                   {Size{322, 182}, 29.97}}) {
    H264Encoder encoder = open({.size = size, .rate = rate});
    const auto units = nal_units(encode(encoder, Image(size)));
    const auto set =
        std::find_if(units.begin(), units.end(), [](const auto& unit) { return (unit.at(0) & 31) == kSequenceSet; });
    ASSERT_NE(set, units.end());
    EXPECT_EQ(fmt::format("avc1.{:02x}{:02x}{:02x}", set->at(1), set->at(2), set->at(3)), H264Encoder::codec(size, rate));
  }
}

TEST(H264Encoder, AFileHasItsParameterSetsApart) {
  H264Encoder encoder = open({.size = kSize, .live = false});
  const auto sets = encoder.parameter_sets();
  EXPECT_EQ(types_of({sets.begin(), sets.end()}), (std::vector<int>{kSequenceSet, kPictureSet}));
  for (const int type : types_of(encode(encoder, test::moving_picture(kSize, 0)))) {
    EXPECT_NE(type, kSequenceSet);
    EXPECT_NE(type, kPictureSet);
  }
  EXPECT_TRUE(open({.size = kSize}).parameter_sets().empty());
}

TEST(H264Encoder, RefusesFewerBitsThanTheCoarsestPicturesTake) {
  const std::int64_t least = h264_least(kSize, 30.0).bit_rate;
  for (const std::int64_t bits : {std::int64_t{-1}, std::int64_t{1}, least - 1}) {
    const auto none = H264Encoder::open({.size = kSize, .bit_rate = bits});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::InvalidParams);
    EXPECT_NE(none.error().message.find(std::to_string(least)), std::string::npos) << none.error().message;
  }
  EXPECT_TRUE(H264Encoder::open({.size = kSize, .bit_rate = least}));
}

/// What packs worst, and where the bits of a picture are.
struct Sent {
  double at_s;
  std::size_t bits;
};

Image noise(Size size, std::mt19937& random) {
  Image image(size);
  for (auto& value : image.rgb) value = static_cast<std::uint8_t>(random());
  return image;
}

/// The most that half-open seconds, each from a picture on, hold.
std::size_t fullest_second(const std::vector<Sent>& sent) {
  std::size_t most = 0;
  for (std::size_t first = 0; first < sent.size(); ++first) {
    std::size_t sum = 0;
    for (std::size_t k = first; k < sent.size() && sent[k].at_s < sent[first].at_s + 1.0 - 1e-9; ++k) sum += sent[k].bits;
    most = std::max(most, sum);
  }
  return most;
}

TEST(H264Encoder, NoSecondTakesMoreBitsThanAllowed) {
  std::mt19937 random(5);
  for (const Size size : {Size{64, 64}, kSize}) {
    for (const double rate : {0.2, 1.0, 4.0, 60.0}) {
      for (const std::int64_t times : {1, 3, 10}) {
        const std::int64_t most = times * h264_least(size, rate).bit_rate;
        H264Encoder encoder = open({.size = size, .rate = rate, .bit_rate = most});
        std::vector<Sent> sent;
        // Two seconds of what plays, then two of what stands still and is asked for again, from between two turns on.
        const auto turns = static_cast<std::size_t>(std::ceil(2.0 * rate));
        for (std::size_t k = 0; k < turns; ++k) {
          const bool key = k % static_cast<std::size_t>(std::ceil(rate / 4.0)) == 0;
          sent.push_back({static_cast<double>(k) / rate, 8 * encode(encoder, noise(size, random), key).size()});
        }
        const double paused_s = (static_cast<double>(turns) - 0.9) / rate;
        const Image still = noise(size, random);
        for (std::size_t k = 0; k < 8; ++k)
          sent.push_back({paused_s + static_cast<double>(k) / 4.0, 8 * encode(encoder, still, true).size()});
        EXPECT_LE(fullest_second(sent), static_cast<std::size_t>(most))
            << size.width << " x " << size.height << " at " << rate << " a second";
      }
    }
  }
}

TEST(H264Encoder, ItUsesTheBitsThatItMay) {
  constexpr std::int64_t kMost = 600'000;
  H264Encoder encoder = open({.size = kSize, .bit_rate = kMost});
  std::mt19937 random(5);
  std::size_t all = 0;
  for (std::size_t k = 0; k < 60; ++k) all += 8 * encode(encoder, noise(kSize, random), k % 50 == 0).size();
  EXPECT_GE(all, static_cast<std::size_t>(kMost)) << "of two seconds";
}

TEST(H264Encoder, WhatDoesNotMoveTakesNextToNothing) {
  H264Encoder encoder = open({.size = kSize});
  const Image image = test::moving_picture(kSize, 3);
  const std::size_t key = encode(encoder, image).size();
  for (std::size_t k = 0; k < 5; ++k) (void)encode(encoder, image);
  EXPECT_LT(encode(encoder, image).size(), key / 8);
}

}  // namespace
}  // namespace tweend::render
