#include "server/animation/skin_vertices.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "tests/animation/every_target.hpp"
#include "tests/animation/random_tracks.hpp"

namespace tweend::animation {
namespace {

/// A random skin, and streams of random vertices.
struct Skinned {
  Skinned(std::uint32_t seed, std::size_t vertices, std::size_t influences) : per_vertex(influences), random(seed) {
    for (int i = 0; i < 30; ++i) {
      Affine matrix;
      for (glm::vec4& row : matrix.rows) row = {number(), number(), number(), number()};
      if (i % 3 == 0) matrix.rows[1] = -matrix.rows[1];  // mirrored
      palette.push_back(matrix);
    }
    for (std::size_t v = 0; v < vertices; ++v) add_vertex();
  }

  void add_vertex() {
    std::vector<float> own(per_vertex, 1.0F);
    float sum = 0.0F;
    for (float& weight : own) sum += weight = random.number(0.01, 1.0);
    for (const float weight : own) weights.push_back(per_vertex == 1 ? 1.0F : weight / sum);
    for (std::size_t i = 0; i < per_vertex; ++i) entries.push_back(static_cast<std::uint16_t>(random.below(palette.size())));
    const glm::vec3 normal = glm::normalize(glm::vec3(random.direction()));
    for (int i = 0; i < 3; ++i) positions.push_back(number()), normals.push_back(normal[i]), tangents.push_back(normal[2 - i]);
  }

  [[nodiscard]] float number() { return random.number(-1, 1); }
  [[nodiscard]] std::size_t vertices() const { return positions.size() / 3; }
  [[nodiscard]] VertexAttributes in() const { return {positions, normals, tangents}; }
  [[nodiscard]] SkinInfluences influences() const { return {per_vertex, entries, weights}; }

  [[nodiscard]] glm::dmat4 blended(std::size_t vertex) const {
    glm::dmat4 sum(0.0);
    for (std::size_t i = vertex * per_vertex; i < (vertex + 1) * per_vertex; ++i) {
      sum += static_cast<double>(weights[i]) * glm::dmat4(to_mat4(palette[entries[i]]));
    }
    return sum;
  }

  std::size_t per_vertex;
  RandomTracks random;
  std::vector<Affine> palette;
  std::vector<std::uint16_t> entries;
  std::vector<float> weights, positions, normals, tangents;
};

struct Output {
  explicit Output(std::size_t vertices) : positions(3 * vertices), normals(3 * vertices), tangents(3 * vertices) {}
  [[nodiscard]] VertexTarget target() { return {positions, normals, tangents}; }
  std::vector<float> positions, normals, tangents;
};

glm::dvec3 at(const std::vector<float>& stream, std::size_t v) { return {stream[3 * v], stream[3 * v + 1], stream[3 * v + 2]}; }

class SkinVertices : public EveryTarget {};
TWEEND_ON_EVERY_TARGET(SkinVertices);

TEST_P(SkinVertices, IsTheWeightedSumOfMatricesForAnyNumberOfVertices) {
  for (const std::size_t influences : {1U, 4U, 8U}) {
    for (std::size_t vertices = 1; vertices < 70; ++vertices) {
      const Skinned skin(static_cast<std::uint32_t>(vertices), vertices, influences);
      Output out(vertices);
      ASSERT_TRUE(skin_vertices(skin.influences(), skin.palette, skin.in(), out.target()));
      for (std::size_t v = 0; v < vertices; ++v) {
        const glm::dmat4 m = skin.blended(v);
        EXPECT_LE(glm::length(at(out.positions, v) - glm::dvec3(m * glm::dvec4(at(skin.positions, v), 1.0))), 2e-6);
        const glm::dmat3 linear(m);
        if (std::abs(glm::determinant(linear)) < 1e-3) continue;  // the normal of something nearly flat is badly known
        const glm::dvec3 normal = glm::normalize(glm::transpose(glm::inverse(linear)) * at(skin.normals, v));
        EXPECT_LE(glm::length(at(out.normals, v) - normal), 5e-5) << influences << ", " << vertices << ", " << v;
        const glm::dvec3 tangent = glm::normalize(linear * at(skin.tangents, v));
        EXPECT_LE(glm::length(at(out.tangents, v) - tangent), 5e-5);
      }
    }
  }
}

TEST_P(SkinVertices, MakesOnlyTheStreamsAskedForAndNothingBesides) {
  for (int streams = 0; streams < 8; ++streams) {
    Skinned skin(5, 37, 4);
    Output out(38);  // one more, which stays
    std::vector<float>* all[] = {&out.positions, &out.normals, &out.tangents};
    for (auto* stream : all) std::ranges::fill(*stream, 9.0F);
    const auto part = [&](int bit) {
      return streams & (1 << bit) ? std::span(*all[bit]).first(std::size_t{3} * 37) : std::span<float>();
    };
    ASSERT_TRUE(skin_vertices(skin.influences(), skin.palette, skin.in(), {part(0), part(1), part(2)}));
    for (int bit = 0; bit < 3; ++bit) {
      EXPECT_EQ(all[bit]->front() != 9.0F, (streams & (1 << bit)) != 0);
      for (std::size_t i = 3 * 37; i < 3 * 38; ++i) EXPECT_EQ((*all[bit])[i], 9.0F);
    }
  }
}

TEST_P(SkinVertices, TheSameVertexComesOutTheSameAnywhere) {
  for (const std::size_t influences : {1U, 4U, 8U}) {
    Skinned skin(6, 1, influences);
    for (int i = 1; i < 50; ++i) {
      for (std::size_t k = 0; k < influences; ++k) skin.entries.push_back(skin.entries[k]);
      for (std::size_t k = 0; k < influences; ++k) skin.weights.push_back(skin.weights[k]);
      for (auto* stream : {&skin.positions, &skin.normals, &skin.tangents}) {
        for (std::size_t k = 0; k < 3; ++k) stream->push_back((*stream)[k]);
      }
    }
    Output out(50);
    ASSERT_TRUE(skin_vertices(skin.influences(), skin.palette, skin.in(), out.target()));
    for (std::size_t v = 1; v < 50; ++v) {
      EXPECT_EQ(at(out.positions, v), at(out.positions, 0));
      EXPECT_EQ(at(out.normals, v), at(out.normals, 0));
      EXPECT_EQ(at(out.tangents, v), at(out.tangents, 0));
    }
  }
}

TEST_P(SkinVertices, WhereNothingIsLeftDirectionsStayAndFlatOnesKeepTheirSide) {
  const std::vector<Affine> palette{
      {{glm::vec4(0), glm::vec4(0), glm::vec4(0)}},                              // all to a point
      {{glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0)}},            // flat
      {{glm::vec4(-2, 0, 0, 0), glm::vec4(0, 2, 0, 0), glm::vec4(0, 0, 2, 0)}},  // mirrored
  };
  const std::vector<std::uint16_t> entries{0, 1, 2};
  const std::vector<float> weights(3, 1.0F);
  const std::vector<float> up{0, 0.6F, 0.8F, 0, 0.6F, 0.8F, 0.6F, 0.8F, 0};
  Output out(3);
  ASSERT_TRUE(skin_vertices({1, entries, weights}, palette, {up, up, up}, out.target()));
  EXPECT_EQ(at(out.normals, 0), at(up, 0));
  EXPECT_EQ(at(out.tangents, 0), at(up, 0));
  EXPECT_EQ(at(out.normals, 1), glm::dvec3(0, 0, 1));
  EXPECT_LE(glm::length(at(out.normals, 2) - glm::dvec3(-0.6, 0.8, 0)), 1e-6);
}

TEST_P(SkinVertices, RefusesLengthsThatDifferAndOddNumbersOfInfluences) {
  Skinned skin(7, 10, 4);
  Output out(10);
  const auto refused = [&](SkinInfluences influences, VertexAttributes in, VertexTarget target) {
    const auto status = skin_vertices(influences, skin.palette, in, target);
    return !status && status.error().code == ErrorCode::Internal && out.positions.front() == 0.0F;
  };
  const SkinInfluences good = skin.influences();
  EXPECT_TRUE(refused({3, good.entries, good.weights}, skin.in(), out.target()));
  EXPECT_TRUE(refused({4, good.entries.first(39), good.weights}, skin.in(), out.target()));
  EXPECT_TRUE(refused({4, good.entries, good.weights.first(36)}, skin.in(), out.target()));
  EXPECT_TRUE(refused(good, {skin.in().positions.first(27), skin.normals, skin.tangents}, out.target()));
  EXPECT_TRUE(refused(good, {skin.positions, {}, skin.tangents}, out.target()));
  EXPECT_TRUE(refused(good, skin.in(), {std::span(out.positions).first(27), {}, {}}));
}

}  // namespace
}  // namespace tweend::animation
