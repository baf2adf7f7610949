#include "server/animation/blend_vertices.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "tests/animation/every_target.hpp"

namespace tweend::animation {
namespace {

constexpr float kUntouched = -77.0F;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Four keyframes in storage that begins `shift` floats past its alignment, and room for the output with guards around.
struct Scene {
  Scene(std::size_t vertices, std::size_t shift, unsigned seed = 5) : size(3 * vertices), offset(shift) {
    std::mt19937 random(seed);
    std::normal_distribution<float> noise;
    for (auto& key : keys) {
      for (std::vector<float>* stream : {&key.positions, &key.normals, &key.tangents}) {
        stream->assign(offset, kUntouched);
        const std::size_t total = offset + size;
        while (stream->size() < total) stream->push_back(noise(random));
        if (stream != &key.positions) normalise(*stream);
      }
    }
    for (auto& stream : output) stream.assign(offset + size + kGuard, kUntouched);
  }

  [[nodiscard]] std::vector<VertexAttributes> sources(std::size_t count) const {
    std::vector<VertexAttributes> result;
    for (std::size_t i = 0; i < count; ++i)
      result.push_back({of(keys[i].positions), of(keys[i].normals), of(keys[i].tangents)});
    return result;
  }
  [[nodiscard]] VertexTarget target() { return {out(0), out(1), out(2)}; }
  [[nodiscard]] std::span<float> out(std::size_t stream) { return std::span(output[stream]).subspan(offset, size); }
  [[nodiscard]] bool guards_hold() const {
    for (const auto& stream : output) {
      for (std::size_t i = 0; i < offset; ++i)
        if (stream[i] != kUntouched) return false;
      for (std::size_t i = offset + size; i < stream.size(); ++i)
        if (stream[i] != kUntouched) return false;
    }
    return true;
  }

  struct Key {
    std::vector<float> positions, normals, tangents;
  };
  std::size_t size;
  std::size_t offset;
  std::array<Key, 4> keys;
  std::array<std::vector<float>, 3> output;

 private:
  static constexpr std::size_t kGuard = 64;
  [[nodiscard]] std::span<const float> of(const std::vector<float>& stream) const {
    return std::span(stream).subspan(offset, size);
  }
  void normalise(std::vector<float>& stream) const {
    for (std::size_t i = offset; i + 2 < stream.size(); i += 3) {
      const float length = std::hypot(stream[i], stream[i + 1], stream[i + 2]);
      for (std::size_t k = 0; k < 3; ++k) stream[i + k] /= length;
    }
  }
};

const std::array<std::vector<float>, 5> kWeights{
    std::vector<float>{}, {0.5F}, {0.3F, 0.7F}, {0.2F, 0.9F, -0.1F}, {-0.0625F, 0.5625F, 0.5625F, -0.0625F}};

double blended(const std::vector<VertexAttributes>& sources, std::span<const float> VertexAttributes::*stream,
               const std::vector<float>& weights, std::size_t i) {
  double sum = 0.0;
  for (std::size_t s = 0; s < sources.size(); ++s)
    sum += static_cast<double>(weights[s]) * static_cast<double>((sources[s].*stream)[i]);
  return sum;
}

/// Compares with the same in double; random directions that nearly cancel out are known only as well as they are long.
void expect_matches_double(Scene& scene, const std::vector<VertexAttributes>& sources, const std::vector<float>& weights) {
  for (std::size_t i = 0; i < scene.size; ++i) {
    EXPECT_NEAR(static_cast<double>(scene.out(0)[i]), blended(sources, &VertexAttributes::positions, weights, i), 1e-6);
  }
  const std::array streams{&VertexAttributes::normals, &VertexAttributes::tangents};
  for (std::size_t stream = 0; stream < 2; ++stream) {
    for (std::size_t v = 0; v < scene.size; v += 3) {
      double xyz[3];
      for (std::size_t k = 0; k < 3; ++k) xyz[k] = blended(sources, streams[stream], weights, v + k);
      const double length = std::hypot(xyz[0], xyz[1], xyz[2]);
      const std::span<float> got = scene.out(stream + 1).subspan(v, 3);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(static_cast<double>(got[k]), xyz[k] / length, 1e-6 / length);
      const double got_length =
          std::hypot(static_cast<double>(got[0]), static_cast<double>(got[1]), static_cast<double>(got[2]));
      EXPECT_NEAR(got_length, 1.0, 1e-6);
    }
  }
}

class BlendVertices : public EveryTarget {};
TWEEND_ON_EVERY_TARGET(BlendVertices);

TEST_P(BlendVertices, MatchesDoubleForEveryLengthAlignmentAndSourceCount) {
  for (std::size_t vertices = 1; vertices <= 70; ++vertices) {
    for (std::size_t count = 1; count <= 4; ++count) {
      Scene scene(vertices, vertices % 5);
      const auto sources = scene.sources(count);
      ASSERT_TRUE(blend_vertices(sources, kWeights[count], 0, scene.target()));
      expect_matches_double(scene, sources, kWeights[count]);
      EXPECT_TRUE(scene.guards_hold()) << vertices << " vertices, " << count << " sources";
      if (HasFailure()) return;
    }
  }
}

TEST_P(BlendVertices, AVertexIsTheSameWhereverItStands) {
  constexpr std::size_t kVertices = 67;
  Scene scene(kVertices, 1);
  const auto sources = scene.sources(4);
  ASSERT_TRUE(blend_vertices(sources, kWeights[4], 0, scene.target()));
  for (std::size_t v = 0; v < kVertices; ++v) {
    std::vector<VertexAttributes> one;
    one.reserve(sources.size());
    for (const auto& s : sources) one.push_back({s.positions.subspan(3 * v, 3), s.normals.subspan(3 * v, 3), {}});
    std::array<float, 3> position{}, normal{};
    ASSERT_TRUE(blend_vertices(one, kWeights[4], 0, {position, normal, {}}));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(position[k], scene.out(0)[3 * v + k]);
      EXPECT_EQ(normal[k], scene.out(1)[3 * v + k]);
    }
  }
}

TEST_P(BlendVertices, CopiesASingleSourceOfWeight1BitForBit) {
  Scene scene(33, 3);
  scene.keys[0].normals[scene.offset + 4] = 5.0F;  // neither unit
  scene.keys[0].normals[scene.offset + 7] = kNan;  // nor a number
  const auto sources = scene.sources(1);
  ASSERT_TRUE(blend_vertices(sources, std::array{1.0F}, 0, scene.target()));
  for (std::size_t i = 0; i < scene.size; ++i) {
    EXPECT_EQ(scene.out(0)[i], sources[0].positions[i]);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(scene.out(1)[i]), std::bit_cast<std::uint32_t>(sources[0].normals[i]));
  }
  EXPECT_TRUE(scene.guards_hold());
}

TEST_P(BlendVertices, OppositeNormalsHalfwayFallBackToTheNearest) {
  for (std::size_t vertices = 1; vertices <= 40; ++vertices) {
    for (const std::size_t count : {std::size_t{2}, std::size_t{4}}) {
      for (std::size_t nearest = 0; nearest < count; ++nearest) {
        Scene scene(vertices, 1);
        for (std::size_t v = 0; v < vertices; v += 2) {  // every other vertex turns round from the first half to the second
          for (std::size_t i = scene.offset + 3 * v; i < scene.offset + 3 * v + 3; ++i) {
            for (std::size_t s = 1; s < count; ++s)
              scene.keys[s].normals[i] = scene.keys[0].normals[i] * (s < count / 2 ? 1.0F : -1.0F);
          }
        }
        const auto sources = scene.sources(count);
        const std::vector<float> weights = count == 2 ? std::vector{0.5F, 0.5F} : kWeights[4];
        ASSERT_TRUE(blend_vertices(sources, weights, nearest, scene.target()));
        for (std::size_t i = 0; i < scene.size; ++i) {
          if (i / 3 % 2 == 1) continue;
          EXPECT_EQ(scene.out(1)[i], sources[nearest].normals[i]) << vertices << ", float " << i;
        }
        for (std::size_t v = 1; v < vertices; v += 2) {
          const auto n = scene.out(1).subspan(3 * v, 3);
          EXPECT_NEAR(std::hypot(n[0], n[1], n[2]), 1.0F, 1e-6F);
        }
      }
    }
  }
}

TEST_P(BlendVertices, ADirectionThatIsNotFiniteFallsBackAndSparesItsNeighbours) {
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    for (std::size_t v = 0; v < 37; ++v) {
      Scene scene(37, 2);
      scene.keys[1].normals[scene.offset + 3 * v + v % 3] = bad;
      Scene clean(37, 2);
      ASSERT_TRUE(blend_vertices(scene.sources(2), kWeights[2], 0, scene.target()));
      ASSERT_TRUE(blend_vertices(clean.sources(2), kWeights[2], 0, clean.target()));
      for (std::size_t i = 0; i < scene.size; ++i) {
        EXPECT_EQ(scene.out(1)[i], i / 3 == v ? scene.sources(1)[0].normals[i] : clean.out(1)[i]);
      }
    }
  }
}

TEST_P(BlendVertices, ComputesOnlyTheStreamsAskedFor) {
  Scene scene(20, 0);
  const auto sources = scene.sources(2);
  ASSERT_TRUE(blend_vertices(sources, kWeights[2], 0, {{}, scene.out(1), {}}));
  EXPECT_EQ(scene.out(0)[0], kUntouched);
  EXPECT_NE(scene.out(1)[0], kUntouched);
  EXPECT_EQ(scene.out(2)[0], kUntouched);
  const std::vector<VertexAttributes> bare{{sources[0].positions, {}, {}}, {sources[1].positions, {}, {}}};
  ASSERT_TRUE(blend_vertices(bare, kWeights[2], 0, {scene.out(0), {}, {}}));
  EXPECT_NE(scene.out(0)[0], kUntouched);
  ASSERT_TRUE(blend_vertices(bare, kWeights[2], 0, {}));
}

TEST_P(BlendVertices, RefusesMisuseAndLeavesTheOutputUntouched) {
  Scene scene(10, 0);
  const auto two = scene.sources(2);
  const auto target = scene.target();
  const auto expect_refused = [&](std::span<const VertexAttributes> sources, std::vector<float> weights, std::size_t nearest,
                                  const VertexTarget& out) {
    const Status status = blend_vertices(sources, weights, nearest, out);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::Internal);
    EXPECT_FALSE(status.error().message.empty());
    for (std::size_t stream = 0; stream < 3; ++stream) {
      for (const float value : scene.output[stream]) ASSERT_EQ(value, kUntouched);
    }
  };
  const std::vector<VertexAttributes> five(5, two[0]);
  expect_refused({}, {}, 0, target);
  expect_refused(five, {0.2F, 0.2F, 0.2F, 0.2F, 0.2F}, 0, target);
  expect_refused(two, {1.0F}, 0, target);
  expect_refused(two, {0.3F, 0.3F, 0.4F}, 0, target);
  expect_refused(two, {0.5F, 0.5F}, 2, target);
  expect_refused(two, {0.5F, 0.5F}, 0, {target.positions.first(27), {}, {}});
  expect_refused(two, {0.5F, 0.5F}, 0, {target.positions, target.normals.first(27), {}});
  auto ragged = two;
  ragged[1].tangents = ragged[1].tangents.first(27);
  expect_refused(ragged, {0.5F, 0.5F}, 0, target);
  ragged[1].tangents = {};
  expect_refused(ragged, {0.5F, 0.5F}, 0, target);
  const std::vector<VertexAttributes> broken{{two[0].positions.first(10), {}, {}}};
  expect_refused(broken, {1.0F}, 0, {target.positions.first(10), {}, {}});
}

}  // namespace
}  // namespace tweend::animation
