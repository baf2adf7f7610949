#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "server/animation/blend_vertices.hpp"
#include "server/animation/key_blend.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/shape.hpp"

namespace tweend::render {
namespace {

using animation::CubicBezier;
using animation::Interpolation;
using animation::KeyBlend;
using animation::VertexAttributes;
using test::Shape;
using test::Tweened;

constexpr std::size_t kVertices = 257;
const std::array<double, 5> kTimes{0.0, 0.3, 1.0, 1.1, 2.5};
constexpr CubicBezier kOvershoot{0.3, -1.5, 0.7, 2.5};  // leaves [0, 1] on both sides

Shape random_shape(bool textured, unsigned seed) {
  Shape shape;
  shape.vertex_count = kVertices;
  for (std::uint32_t i = 0; i < 3 * (kVertices / 3); ++i) shape.indices.push_back(i);
  if (textured) shape.texcoords.assign(2 * kVertices, 0.5F);
  for (unsigned k = 0; k < kTimes.size(); ++k) shape.blocks.push_back(test::random_block(kVertices, textured, seed + k));
  return shape;
}

DrawItem item_of(const Shape& shape, const KeyBlend& blend) {
  DrawItem item;
  item.mesh = shape.source();
  item.key_count = blend.count;
  item.keys_expected = shape.blocks.size();
  for (std::size_t i = 0; i < blend.count; ++i) item.key[i] = shape.key(blend.key[i]);
  item.weight = blend.weight;
  item.nearest = blend.nearest;
  return item;
}

VertexAttributes attributes(const std::vector<float>& block, bool textured) {
  const std::span<const float> all(block);
  constexpr std::size_t kStream = 3 * kVertices;
  return {all.first(kStream), all.subspan(kStream, kStream), textured ? all.subspan(2 * kStream) : std::span<const float>{}};
}

/// The processor's answer.
Tweened blended(const Shape& shape, const KeyBlend& blend) {
  const bool textured = !shape.texcoords.empty();
  std::vector<VertexAttributes> sources;
  for (std::size_t i = 0; i < blend.count; ++i) sources.push_back(attributes(shape.blocks[blend.key[i]], textured));
  Tweened out;
  out.positions.resize(3 * kVertices);
  out.normals.resize(3 * kVertices);
  if (textured) out.tangents.resize(3 * kVertices);
  const Status status = animation::blend_vertices(sources, std::span(blend.weight).first(blend.count), blend.nearest,
                                                  {out.positions, out.normals, out.tangents});
  EXPECT_TRUE(status);
  return out;
}

/// How long a blended direction was before it was scaled, in double: rounding errors grow as it shrinks.
double blended_length(const Shape& shape, const KeyBlend& blend, std::size_t first) {
  std::array<double, 3> sum{};
  for (std::size_t i = 0; i < blend.count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += static_cast<double>(blend.weight[i]) * static_cast<double>(shape.blocks[blend.key[i]][first + k]);
    }
  }
  return std::hypot(sum[0], sum[1], sum[2]);
}

float greatest(const std::vector<float>& values) {
  float most = 0.0F;
  for (const float v : values) most = std::max(most, std::abs(v));
  return most;
}

void expect_directions_match(const Shape& shape, const KeyBlend& blend, const std::vector<float>& gpu,
                             const std::vector<float>& cpu, std::size_t stream) {
  ASSERT_EQ(gpu.size(), cpu.size());
  for (std::size_t i = 0; i < cpu.size(); ++i) {
    const double length = blended_length(shape, blend, stream * 3 * kVertices + i - i % 3);
    EXPECT_NEAR(gpu[i], cpu[i], std::max(1e-5, 1e-6 / length)) << "stream " << stream << ", float " << i;
  }
}

class Tween : public testing::Test {
 protected:
  void expect_same(const Shape& shape, const KeyBlend& blend) {
    SCOPED_TRACE(testing::Message() << blend.count << " keyframes, weights " << blend.weight[0] << ", " << blend.weight[1]
                                    << ", " << blend.weight[2] << ", " << blend.weight[3]);
    const Tweened cpu = blended(shape, blend);
    const Tweened gpu = test::capture_tween(gpu_.renderer().cache(), item_of(shape, blend));
    const float bounds = greatest(cpu.positions);
    ASSERT_EQ(gpu.positions.size(), cpu.positions.size());
    for (std::size_t i = 0; i < cpu.positions.size(); ++i) EXPECT_NEAR(gpu.positions[i], cpu.positions[i], 1e-5F * bounds);
    expect_directions_match(shape, blend, gpu.normals, cpu.normals, 1);
    expect_directions_match(shape, blend, gpu.tangents, cpu.tangents, 2);
  }
  /// At keyframes, between them and near them, in every gap between the times.
  void expect_same_everywhere(Interpolation mode, bool closed, const CubicBezier* easing, std::array<bool, 5>& counts) {
    const animation::KeyTimeline timeline{kTimes, closed ? 3.5 : 2.5, closed};
    for (const bool textured : {false, true}) {
      const Shape shape = random_shape(textured, 11);
      for (const double time_s : {0.0, 0.01, 0.15, 0.3, 0.9, 1.05, 1.7, 2.499, 2.5, 3.0, 3.49}) {
        const KeyBlend blend = blend_keys(timeline, locate(timeline, time_s), mode, easing);
        counts[blend.count] = true;
        expect_same(shape, blend);
        if (HasFailure()) return;
      }
    }
  }
  test::Offscreen gpu_;
  std::array<bool, 5> counts_{};  ///< which numbers of keyframes were blended
};

TEST_F(Tween, AgreesWithTheProcessorWhereOneOrTwoKeyframesMakeAMoment) {
  expect_same_everywhere(Interpolation::Step, false, nullptr, counts_);
  expect_same_everywhere(Interpolation::Linear, false, nullptr, counts_);
  expect_same_everywhere(Interpolation::Linear, true, nullptr, counts_);
  EXPECT_TRUE(counts_[1] && counts_[2]);
}

TEST_F(Tween, AgreesWithTheProcessorWhereThreeOrFourKeyframesMakeAMoment) {
  expect_same_everywhere(Interpolation::CatmullRom, false, nullptr, counts_);
  expect_same_everywhere(Interpolation::CatmullRom, true, nullptr, counts_);
  EXPECT_TRUE(counts_[1] && counts_[3] && counts_[4]) << "an open end blends three";
}

TEST_F(Tween, AgreesWithTheProcessorWhereAnEasingOvershoots) {
  const animation::KeyTimeline timeline{kTimes, 2.5, false};
  const KeyBlend blend = blend_keys(timeline, locate(timeline, 0.4), Interpolation::Linear, &kOvershoot);
  ASSERT_LT(std::min(blend.weight[0], blend.weight[1]), -0.05F) << "the easing was to overshoot";
  expect_same_everywhere(Interpolation::Linear, false, &kOvershoot, counts_);
  expect_same_everywhere(Interpolation::CatmullRom, true, &kOvershoot, counts_);
}

TEST_F(Tween, OppositeDirectionsFallBackToTheNearestKeyframe) {
  for (const std::size_t count : {2U, 3U, 4U}) {
    Shape shape = random_shape(true, 40);
    for (std::size_t k = 1; k < count; ++k) {
      shape.blocks[k] = shape.blocks[0];
      if (k < count - count / 2) continue;
      for (std::size_t i = 3 * kVertices; i < shape.blocks[k].size(); ++i) shape.blocks[k][i] *= -1.0F;
    }
    KeyBlend blend{static_cast<std::uint32_t>(count), {0, 1, 2, 3}, {}, 0};
    blend.weight = count == 2   ? std::array{0.5F, 0.5F, 0.0F, 0.0F}
                   : count == 3 ? std::array{0.75F, -0.25F, 0.5F, 0.0F}
                                : std::array{-0.0625F, 0.5625F, 0.5625F, -0.0625F};
    for (blend.nearest = 0; blend.nearest < count; ++blend.nearest) {
      const Tweened gpu = test::capture_tween(gpu_.renderer().cache(), item_of(shape, blend));
      const Tweened cpu = blended(shape, blend);
      EXPECT_EQ(gpu.normals, cpu.normals) << count << " keyframes, nearest " << blend.nearest;
      EXPECT_EQ(gpu.tangents, cpu.tangents);
      const auto nearest = attributes(shape.blocks[blend.nearest], true).normals;
      EXPECT_EQ(gpu.normals, std::vector<float>(nearest.begin(), nearest.end()));
    }
  }
}

TEST_F(Tween, ASingleKeyframeIsTakenAsItIs) {
  Shape shape = random_shape(true, 3);
  shape.blocks[0][3 * kVertices + 1] = 5.0F;  // not unit: one keyframe is not looked into
  const KeyBlend blend{1, {0}, {1.0F}, 0};
  const Tweened gpu = test::capture_tween(gpu_.renderer().cache(), item_of(shape, blend));
  const Tweened cpu = blended(shape, blend);
  EXPECT_EQ(gpu.positions, cpu.positions);
  EXPECT_EQ(gpu.normals, cpu.normals);
  EXPECT_EQ(gpu.tangents, cpu.tangents);
}

}  // namespace
}  // namespace tweend::render
