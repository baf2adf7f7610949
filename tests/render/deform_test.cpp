#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <random>
#include <vector>

#include "server/animation/morph_vertices.hpp"
#include "server/animation/skin_vertices.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/shape.hpp"

// What the vertex shader makes of a keyframe, a palette and morph weights, beside the same in plain double precision and
// beside the processor's way, which the streams of vertices take.

namespace tweend::render {
namespace {

using animation::Affine;
using test::Shape;
using test::Tweened;

constexpr std::size_t kVertices = 203;
constexpr std::size_t kEntries = 37;

struct Morph {
  std::size_t first_vertex = 0;
  std::vector<float> positions;
  std::vector<float> normals;
};

/// A mesh of noise with everything that deforms it.
struct Posed {
  Shape shape;
  std::vector<Morph> morphs;
  std::vector<Affine> palette;
  std::vector<float> morph_weights;

  [[nodiscard]] DrawItem item() const {
    DrawItem item = shape.item();
    if (!palette.empty()) item.palette = {&palette.front().rows[0].x, 12 * palette.size()};
    item.morph_weights = morph_weights;
    return item;
  }
};

/// Turned any way, scaled by another factor along each axis; every third one is mirrored.
std::vector<Affine> random_palette(std::size_t entries, std::mt19937& random) {
  std::normal_distribution<float> noise;
  std::uniform_real_distribution<float> scale(0.3F, 2.0F);
  std::vector<Affine> palette;
  for (std::size_t i = 0; i < entries; ++i) {
    glm::mat4 m = glm::translate(glm::mat4(1.0F), glm::vec3(noise(random), noise(random), noise(random)));
    m = glm::rotate(m, 3.0F * noise(random), glm::normalize(glm::vec3(noise(random), noise(random), 0.1F)));
    m = glm::scale(m, glm::vec3(scale(random), scale(random), i % 3 == 0 ? -scale(random) : scale(random)));
    m = glm::rotate(m, 3.0F * noise(random), glm::vec3(0.6F, 0.0F, 0.8F));
    palette.push_back(animation::to_affine(m));
  }
  return palette;
}

Posed random_mesh(bool textured, std::size_t influences, std::mt19937& random) {
  Posed posed;
  Shape& shape = posed.shape;
  shape.vertex_count = kVertices;
  for (std::uint32_t i = 0; i < 3 * (kVertices / 3); ++i) shape.indices.push_back(i);
  if (textured) shape.texcoords.assign(2 * kVertices, 0.5F);
  shape.blocks.push_back(test::random_block(kVertices, textured, static_cast<unsigned>(random())));
  shape.influences = influences;
  std::uniform_real_distribution<float> weight(0.0F, 1.0F);
  for (std::size_t v = 0; v < kVertices && influences > 0; ++v) {
    float sum = 0.0F;
    for (std::size_t i = 0; i < influences; ++i) {
      shape.entries.push_back(static_cast<std::uint16_t>(random() % kEntries));
      shape.entry_weights.push_back(influences == 1 ? 1.0F : weight(random));
      sum += shape.entry_weights.back();
    }
    for (std::size_t i = 0; i < influences; ++i) shape.entry_weights[v * influences + i] /= sum;
  }
  if (influences > 0) posed.palette = random_palette(kEntries, random);
  return posed;
}

/// Targets that cover all, the beginning, the middle, one vertex, and none; with normals and without.
void add_morphs(Posed& posed, std::vector<float> weights, std::mt19937& random) {
  struct Run {
    std::size_t first, count;
    bool normals;
  };
  std::normal_distribution<float> noise(0.0F, 0.4F);
  for (const Run& run : {Run{0, kVertices, true}, Run{0, 50, true}, Run{40, 60, false}, Run{kVertices - 1, 1, true},
                         Run{10, 0, false}, Run{30, 100, true}}) {
    Morph& morph = posed.morphs.emplace_back();
    morph.first_vertex = run.first;
    for (std::size_t i = 0; i < 3 * run.count; ++i) morph.positions.push_back(noise(random));
    for (std::size_t i = 0; i < 3 * run.count && run.normals; ++i) morph.normals.push_back(noise(random));
  }
  for (const Morph& morph : posed.morphs) posed.shape.morphs.push_back({morph.first_vertex, morph.positions, morph.normals});
  posed.morph_weights = std::move(weights);
}

using Vec3d = glm::dvec3;

Vec3d at(const std::vector<float>& values, std::size_t vertex) {
  return {values[3 * vertex], values[3 * vertex + 1], values[3 * vertex + 2]};
}

struct PointD {
  Vec3d position;
  Vec3d normal;
  double normal_length = 1.0;  ///< before it was scaled: rounding errors grow as it shrinks
};

/// One vertex in double, by the definitions: displaced, then moved by the weighted sum of matrices, the normal by its inverse
/// transpose.
PointD reference(const Posed& posed, std::size_t v) {
  const std::vector<float>& block = posed.shape.blocks[0];
  PointD out{at(block, v), at(block, kVertices + v)};
  bool turned = false;
  for (std::size_t i = 0; i < posed.morph_weights.size(); ++i) {
    const Morph& morph = posed.morphs[i];
    const double weight = posed.morph_weights[i];
    if (weight == 0.0 || v < morph.first_vertex || v >= morph.first_vertex + morph.positions.size() / 3) continue;
    out.position += weight * at(morph.positions, v - morph.first_vertex);
    if (morph.normals.empty()) continue;
    out.normal += weight * at(morph.normals, v - morph.first_vertex);
    turned = true;
  }
  if (turned) {
    out.normal_length = glm::length(out.normal);
    out.normal /= out.normal_length;
  }
  const std::size_t each = posed.palette.empty() ? 0 : posed.shape.influences;
  if (each == 0) return out;
  glm::dmat4 sum(0.0);
  for (std::size_t i = 0; i < each; ++i) {
    const std::size_t k = v * each + i;
    sum += static_cast<double>(posed.shape.entry_weights[k]) *
           glm::dmat4(animation::to_mat4(posed.palette[posed.shape.entries[k]]));
  }
  out.position = Vec3d(sum * glm::dvec4(out.position, 1.0));
  const glm::dmat3 linear(sum);
  const Vec3d turned_normal = glm::inverseTranspose(linear) * out.normal;
  // How much a rounding error of the matrix's elements weighs against what is left of the normal.
  const double size = glm::length(linear[0]) + glm::length(linear[1]) + glm::length(linear[2]);
  out.normal_length *= std::min(1.0, glm::length(turned_normal) * std::abs(glm::determinant(linear)) / (size * size));
  out.normal = glm::normalize(turned_normal);
  return out;
}

/// The processor's answer, as model::Evaluator has it made.
Tweened by_processor(const Posed& posed) {
  std::vector<float> morphed(posed.shape.blocks[0].begin(), posed.shape.blocks[0].begin() + 6 * kVertices);
  const std::span<float> all(morphed);
  const animation::VertexTarget base{all.first(3 * kVertices), all.subspan(3 * kVertices), {}};
  std::vector<animation::MorphTargetView> views;
  for (const Morph& m : posed.morphs) {
    views.push_back({m.first_vertex, m.positions.size() / 3, {m.positions, m.normals, {}}});
  }
  if (!posed.morph_weights.empty()) animation::morph_vertices(views, posed.morph_weights, base);
  Tweened out;
  out.positions.assign(base.positions.begin(), base.positions.end());
  out.normals.assign(base.normals.begin(), base.normals.end());
  if (posed.palette.empty()) return out;
  const Status done =
      animation::skin_vertices({posed.shape.influences, posed.shape.entries, posed.shape.entry_weights}, posed.palette,
                               {base.positions, base.normals, {}}, {out.positions, out.normals, {}});
  EXPECT_TRUE(done);
  return out;
}

class Deform : public testing::Test {
 protected:
  void expect_same(const Posed& posed) {
    const Tweened gpu = test::capture_tween(gpu_.renderer().cache(), posed.item());
    const Tweened cpu = by_processor(posed);
    double bounds = 0.0;
    for (const float p : cpu.positions) bounds = std::max(bounds, std::abs(static_cast<double>(p)));
    for (std::size_t v = 0; v < kVertices; ++v) {
      const PointD expected = reference(posed, v);
      const double loose = std::max(1e-5, 3e-6 / expected.normal_length);
      EXPECT_LE(glm::distance(at(gpu.positions, v), expected.position), 1e-5 * bounds) << "vertex " << v;
      EXPECT_LE(glm::distance(at(gpu.positions, v), at(cpu.positions, v)), 1e-5 * bounds) << "vertex " << v;
      EXPECT_LE(glm::distance(at(gpu.normals, v), expected.normal), loose) << "vertex " << v;
      EXPECT_LE(glm::distance(at(gpu.normals, v), at(cpu.normals, v)), loose) << "vertex " << v;
      if (HasFailure()) return;
    }
  }
  test::Offscreen gpu_;
  std::mt19937 random_{7};
};

TEST_F(Deform, SkinsWithOneFourAndEightInfluencesAsTheProcessorDoes) {
  for (const std::size_t influences : {1U, 4U, 8U}) {
    for (const bool textured : {false, true}) {
      SCOPED_TRACE(testing::Message() << influences << " influences" << (textured ? ", textured" : ""));
      expect_same(random_mesh(textured, influences, random_));
    }
  }
}

TEST_F(Deform, MorphsByAnyNumberOfTargetsAsTheProcessorDoes) {
  for (const std::vector<float>& weights :
       {std::vector<float>{1, 0, 0, 0, 0, 0}, {0, 0.5F, 0, 0, 1, 0}, {0.3F, -0.7F, 1.5F, 1, 0.2F, 0.4F}, {0, 0, 1, 0, 0, 0}}) {
    Posed posed = random_mesh(true, 0, random_);
    add_morphs(posed, weights, random_);
    expect_same(posed);
  }
}

TEST_F(Deform, MorphsFirstAndSkinsThen) {
  for (const std::size_t influences : {1U, 4U, 8U}) {
    Posed posed = random_mesh(false, influences, random_);
    add_morphs(posed, {0.8F, 0.5F, -1, 1, 0, 0.25F}, random_);
    expect_same(posed);
  }
}

TEST_F(Deform, WithoutWeightsAndPaletteTheKeyframeIsShownAsItIs) {
  Posed posed = random_mesh(false, 4, random_);
  add_morphs(posed, {0, 0, 0, 0, 0, 0}, random_);
  posed.palette.clear();
  DrawItem item = posed.shape.item();
  item.morph_weights = posed.morph_weights;
  const Tweened gpu = test::capture_tween(gpu_.renderer().cache(), item);
  const std::vector<float>& block = posed.shape.blocks[0];
  EXPECT_EQ(gpu.positions, std::vector<float>(block.begin(), block.begin() + 3 * kVertices));
  EXPECT_EQ(gpu.normals, std::vector<float>(block.begin() + 3 * kVertices, block.end()));
}

TEST_F(Deform, TheLastOf65536EntriesIsAsGoodAsTheFirst) {
  Posed posed = random_mesh(false, 4, random_);
  posed.palette.resize(65536);
  for (std::size_t i = 0; i < posed.shape.entries.size(); i += 2) {
    posed.palette[65535 - posed.shape.entries[i]] = posed.palette[posed.shape.entries[i]];
    posed.shape.entries[i] = static_cast<std::uint16_t>(65535 - posed.shape.entries[i]);
  }
  expect_same(posed);
}

TEST_F(Deform, WhereAJointIsScaledAwayTheNormalStaysAsItWas) {
  Posed posed = random_mesh(false, 1, random_);
  posed.palette.assign(kEntries, {{glm::vec4(0), glm::vec4(0), glm::vec4(0)}});
  const Tweened gpu = test::capture_tween(gpu_.renderer().cache(), posed.item());
  EXPECT_EQ(gpu.positions, std::vector<float>(3 * kVertices, 0.0F));
  const std::vector<float>& block = posed.shape.blocks[0];
  EXPECT_EQ(gpu.normals, std::vector<float>(block.begin() + 3 * kVertices, block.end()));
  EXPECT_EQ(gpu.normals, by_processor(posed).normals);
}

TEST_F(Deform, ATargetWhoseNormalsCancelLeavesThem) {
  Posed posed = random_mesh(false, 0, random_);
  add_morphs(posed, {1, 0, 0, 0, 0, 0}, random_);
  const std::vector<float>& block = posed.shape.blocks[0];
  for (std::size_t i = 0; i < 3 * kVertices; ++i) posed.morphs[0].normals[i] = -block[3 * kVertices + i];
  const Tweened gpu = test::capture_tween(gpu_.renderer().cache(), posed.item());
  EXPECT_EQ(gpu.normals, std::vector<float>(block.begin() + 3 * kVertices, block.end()));
  EXPECT_EQ(gpu.normals, by_processor(posed).normals);
}

TEST_F(Deform, VerticesOfTheMomentStandInForKeyframes) {
  Posed posed = random_mesh(true, 4, random_);
  const std::vector<float> moment = test::random_block(kVertices, true, 99);
  DrawItem item = posed.shape.item();
  item.vertices = moment;
  const Tweened gpu = test::capture_tween(gpu_.renderer().cache(), item);
  const auto stream = [&](std::ptrdiff_t i) {
    constexpr std::ptrdiff_t kStream = 3 * kVertices;
    return std::vector<float>(moment.begin() + i * kStream, moment.begin() + (i + 1) * kStream);
  };
  EXPECT_EQ(gpu.positions, stream(0));
  EXPECT_EQ(gpu.normals, stream(1));
  EXPECT_EQ(gpu.tangents, stream(2));
  EXPECT_EQ(gpu_.renderer().cache().key_uploads(), 0U) << "they are of no keyframe";
}

}  // namespace
}  // namespace tweend::render
