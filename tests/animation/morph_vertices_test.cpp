#include "server/animation/morph_vertices.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "tests/animation/every_target.hpp"
#include "tests/animation/random_tracks.hpp"

namespace tweend::animation {
namespace {

std::vector<float> numbers(RandomTracks& random, std::size_t count) {
  std::vector<float> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(random.number(-1, 1));
  return result;
}

glm::dvec3 at(std::span<const float> stream, std::size_t v) { return {stream[3 * v], stream[3 * v + 1], stream[3 * v + 2]}; }

/// Targets over runs of their own, some without normals.
struct Morph {
  Morph(std::uint32_t seed, std::size_t vertices, std::size_t targets) : random(seed) {
    for (std::size_t i = 0; i < targets; ++i) {
      const std::size_t first = i == 0 ? 0 : random.below(vertices);
      const std::size_t count = i == 0 ? vertices : random.below(vertices - first + 1);
      runs.push_back({first, count, {}});
      positions.push_back(numbers(random, 3 * count));
      normals.push_back(numbers(random, i % 4 == 3 ? 0 : 3 * count));
      weights.push_back(i % 3 == 1 ? 0.0F : random.number(-0.5, 1.0));
    }
    for (std::size_t i = 0; i < targets; ++i) runs[i].displacements = {positions[i], normals[i], {}};
  }

  /// base + Σ weight · displacement; and whether any target with this stream covers the vertex.
  [[nodiscard]] glm::dvec3 sum(const std::vector<std::vector<float>>& streams, glm::dvec3 base, std::size_t v,
                               bool& any) const {
    any = false;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const bool covers = v >= runs[i].first_vertex && v < runs[i].first_vertex + runs[i].vertex_count;
      if (weights[i] == 0.0F || streams[i].empty() || !covers) continue;
      base += static_cast<double>(weights[i]) * at(streams[i], v - runs[i].first_vertex);
      any = true;
    }
    return base;
  }

  RandomTracks random;
  std::vector<MorphTargetView> runs;
  std::vector<std::vector<float>> positions, normals;
  std::vector<float> weights;
};

class MorphVertices : public EveryTarget {};
TWEEND_ON_EVERY_TARGET(MorphVertices);

TEST_P(MorphVertices, AddsTheWeightedDisplacementsOfEveryRun) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    RandomTracks random(seed);
    const std::size_t vertices = 1 + random.below(seed % 4 == 0 ? 900 : 40);
    const Morph morph(seed, vertices, random.below(12));
    const std::vector<float> base = numbers(random, 3 * vertices);
    std::vector<float> normals;
    for (std::size_t v = 0; v < vertices; ++v) {
      const glm::vec3 normal = glm::normalize(glm::vec3(random.direction()));
      normals.insert(normals.end(), {normal.x, normal.y, normal.z});
    }
    std::vector<float> out_positions = base, out_normals = normals;
    morph_vertices(morph.runs, morph.weights, {out_positions, out_normals, {}});
    for (std::size_t v = 0; v < vertices; ++v) {
      bool touched = false;
      EXPECT_LE(glm::length(at(out_positions, v) - morph.sum(morph.positions, at(base, v), v, touched)), 1e-6);
      if (!touched) {
        EXPECT_EQ(at(out_positions, v), at(base, v));
      }
      const glm::dvec3 normal = morph.sum(morph.normals, at(normals, v), v, touched);
      if (!touched) {
        EXPECT_EQ(at(out_normals, v), at(normals, v));
      } else if (glm::length(normal) > 0.05) {
        EXPECT_LE(glm::length(at(out_normals, v) - glm::normalize(normal)), 2e-5);
      }
    }
  }
}

TEST_P(MorphVertices, WithoutWeightsOrTargetsChangesNothing) {
  const Morph morph(1, 20, 5);
  const std::vector<float> base(60, 0.7F);
  std::vector<float> positions = base, normals = base;
  morph_vertices(morph.runs, std::vector<float>(5, 0.0F), {positions, normals, {}});
  morph_vertices({}, {}, {positions, normals, {}});
  EXPECT_EQ(positions, base);
  EXPECT_EQ(normals, base);
}

TEST_P(MorphVertices, ANormalThatVanishesStaysAsItWas) {
  const std::vector<float> base{0, 1, 0}, away{0, -1, 0};
  std::vector<float> normals = base;
  const std::vector<MorphTargetView> targets{{0, 1, {{}, away, {}}}};
  morph_vertices(targets, std::vector<float>{1.0F}, {{}, normals, {}});
  EXPECT_EQ(normals, base);
}

}  // namespace
}  // namespace tweend::animation
