#include "protocol/vertices_q16.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/protocol/codec_inputs.hpp"
#include "tests/protocol/vertex_errors.hpp"

namespace tweend::protocol {
namespace {

std::vector<std::byte> encoded(const Vertices& in) {
  std::vector<std::byte> payload(vertices_q16_bytes(in.positions.size() / 3));
  encode_vertices_q16(in.positions, in.normals, payload);
  return payload;
}

Vertices through(const Vertices& in) {
  Vertices out{std::vector<float>(in.positions.size()), std::vector<float>(in.normals.size())};
  const Status status = decode_vertices_q16(encoded(in), out.positions, out.normals);
  EXPECT_TRUE(status) << status.error().message;
  return out;
}

TEST(VerticesQ16, RefusesAnyOtherSizeAndBoundsThatAreNone) {
  const Vertices in = wavy_sphere(3, 5, 0);
  const auto refused = [&](std::vector<std::byte> payload, std::string_view words) {
    Vertices out{std::vector<float>(45, -7.0F), std::vector<float>(45, -7.0F)};
    const Status status = decode_vertices_q16(payload, out.positions, out.normals);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::Parse);
    EXPECT_NE(status.error().message.find(words), std::string::npos) << status.error().message;
    EXPECT_EQ(out.positions, std::vector<float>(45, -7.0F));
    EXPECT_EQ(out.normals, std::vector<float>(45, -7.0F));
  };
  const auto payload = encoded(in);
  ASSERT_EQ(payload.size(), 24 + 15 * 10U);
  for (std::size_t size = 0; size < payload.size(); ++size) {
    refused({payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(size)}, "expected 174 bytes for 15 vertices");
  }
  auto longer = payload;
  longer.emplace_back();
  refused(longer, "found 175");
  auto infinite = payload;
  infinite[2] = std::byte{0x80}, infinite[3] = std::byte{0x7F};
  refused(infinite, "finite bounds");
  auto negative = payload;
  negative[15] = std::byte{0xBF};
  refused(negative, "finite bounds");
}

TEST(VerticesQ16, IsWrittenByteByByteAsThePageSays) {
  const Vertices in{{1.0F, -2.0F, 5.0F, 3.0F, 2.0F, 5.0F, 2.0F, -1.0F, 5.0F}, {1, 0, 0, 0, 0, -1, 0, 0, 0}};
  std::vector<int> found;
  for (const std::byte b : encoded(in)) found.push_back(std::to_integer<int>(b));
  const std::vector<int> by_hand{
      0,    0,    0x80, 0x3F, 0, 0, 0,    0xC0, 0,    0,    0xA0, 0x40,  // least 1, -2, 5
      0,    0,    0,    0x40, 0, 0, 0x80, 0x40, 0,    0,    0,    0,     // extent 2, 4, 0
      0,    0,    0,    0,    0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0,    0,     // the corners
      0x00, 0x80, 0x00, 0x40, 0, 0,  // half of the way: 32767.5 is 32768; a quarter: 16383.75
      0xFF, 0x7F, 0,    0,           // +x
      0xFF, 0x7F, 0xFF, 0x7F,        // -z: a corner of the square
      0x00, 0x80, 0,    0,           // none
  };
  EXPECT_EQ(found, by_hand);
}

TEST(VerticesQ16, KeepsTheStatedErrors) {
  const Vertices in = wavy_sphere(150, 300, 1.0);
  const Vertices out = through(in);
  expect_near_positions(in.positions, out.positions, extent_of(encoded(in)));
  EXPECT_LE(worst_angle(in.normals, out.normals), kFineNormalError);
}

TEST(VerticesQ16, DirectionsKeepTheStatedAngleAllOverTheSphere) {
  Noise noise(11);
  Vertices in;
  while (in.normals.size() < 3'000'000) {
    const double x = noise.next(), y = noise.next(), z = noise.next();
    const double length = std::hypot(x, y, z);
    if (length > 1.0 || length < 0.1) continue;
    for (const double c : {x, y, z}) in.normals.push_back(static_cast<float>(c / length));
  }
  in.positions.resize(in.normals.size());
  const double worst = worst_angle(in.normals, through(in).normals);
  EXPECT_LE(worst, kFineNormalError);
  EXPECT_GE(worst, kFineNormalError / 2) << "the stated error could be smaller";
}

TEST(VerticesQ16, AxesAreExactAndNormalsThatAreNoneStayNone) {
  const Vertices in{std::vector<float>(21, 4.0F), {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0}};
  const Vertices out = through(in);
  EXPECT_EQ(out.normals, in.normals);
  EXPECT_EQ(out.positions, in.positions) << "one point has no extent";
}

TEST(VerticesQ16, NoVerticesAreTheirBoundsAlone) {
  EXPECT_EQ(encoded({}), std::vector<std::byte>(24));
  through({});
}

TEST(VerticesQ16, AFlatMeshStaysFlat) {
  Vertices in = wavy_sphere(20, 20, 0);
  for (std::size_t i = 1; i < in.positions.size(); i += 3) in.positions[i] = 0.1F;
  const Vertices out = through(in);
  for (std::size_t i = 1; i < in.positions.size(); i += 3) ASSERT_EQ(out.positions[i], 0.1F);
  expect_near_positions(in.positions, out.positions, extent_of(encoded(in)));
}

TEST(VerticesQ16, WhatIsTooFarAwayOrNotFiniteIsSentAsTheNearestThatIs) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    for (const std::size_t n : {1U, 3U, 40U}) {
      const Vertices in = odd_vertices(n, 5);
      const Vertices out = through(in), meant = tamed(in);
      expect_near_positions(meant.positions, out.positions, extent_of(encoded(in)));
      EXPECT_LE(worst_angle(meant.normals, out.normals), kFineNormalError) << hwy::TargetName(target);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

TEST(VerticesQ16, WhatIsAlmostFlatCountsAsFlat) {
  constexpr float kLeast = std::numeric_limits<float>::denorm_min();
  const Vertices in{{0, 0, 1e-31F, 1, kLeast, 0, 0, 0, 5e-32F}, {1, 0, 0, 1, 0, 0, 1, 0, 0}};
  const Vertices out = through(in);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(out.positions[i], in.positions[i], 1e-30);
}

TEST(VerticesQ16, AVertexDoesNotDependOnItsPlaceOrOnHowManyThereAre) {
  const Vertices all = wavy_sphere(9, 11, 0.3);
  const Vertices out = through(all);
  for (std::size_t n = 2; n <= 70; ++n) {
    // The first two are the corners of the bounds, so that all cuts have the same grid.
    Vertices some{{-2, -2, -2, 2, 2, 2}, {0, 0, 0, 0, 0, 0}};
    some.positions.insert(some.positions.end(), all.positions.end() - static_cast<std::ptrdiff_t>(3 * (n - 2)),
                          all.positions.end());
    some.normals.insert(some.normals.end(), all.normals.end() - static_cast<std::ptrdiff_t>(3 * (n - 2)), all.normals.end());
    const Vertices found = through(some);
    for (std::size_t back = 1; back <= n - 2; ++back) {
      for (std::size_t k = 1; k <= 3; ++k) {
        const std::size_t at = 3 * back - k + 1;
        ASSERT_EQ(*(found.normals.end() - static_cast<std::ptrdiff_t>(at)),
                  *(out.normals.end() - static_cast<std::ptrdiff_t>(at)));
      }
    }
    expect_near_positions(some.positions, found.positions, {4, 4, 4});
  }
}

TEST(VerticesQ16, BytesAreTheSameOnEveryVectorUnit) {
  const Vertices in = wavy_sphere(37, 41, 0.7);
  const auto payload = encoded(in);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();  // choose anew at the next call
    EXPECT_EQ(encoded(in), payload) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

}  // namespace
}  // namespace tweend::protocol
