#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <span>
#include <tuple>
#include <vector>

#include "server/animation/affine.hpp"
#include "server/animation/vertex_normals.hpp"
#include "tests/render/support/compare.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/shape.hpp"

// Whole pictures of what the GPU deforms, of bones, and of materials, against ones that were looked at once, in
// tests/render/golden.

namespace tweend::render {
namespace {

using animation::Affine;
using test::Shape;

constexpr Size kSize{360, 270};

Picture studio(const glm::vec3& eye, const glm::vec3& target) {
  Picture picture;
  picture.size = kSize;
  picture.view.eye = eye;
  picture.view.view_from_world = glm::lookAt(eye, target, glm::vec3(0.0F, 1.0F, 0.0F));
  picture.view.clip_from_view = glm::perspective(glm::radians(40.0F), 4.0F / 3.0F, 0.05F, 100.0F);
  picture.view.focus_m = glm::length(eye - target);
  picture.light = {{2.5F, 4.0F, 3.0F}, 0.2F, 0.8F, 0.4F, 40.0F};
  picture.background = {0.12F, 0.13F, 0.15F};
  return picture;
}

void set_normals(Shape& shape) {
  const std::size_t stream = 3 * shape.vertex_count;
  const std::span<float> all(shape.blocks[0]);
  EXPECT_TRUE(animation::compute_normals(all.first(stream), shape.indices, all.subspan(stream, stream)));
}

constexpr std::size_t kBarJoints = 4;
constexpr float kBarStep = 0.6F;  // between joints, metres

/// A square bar, standing on the origin, with a joint every kBarStep; each vertex follows the two joints around it.
Shape bar() {
  constexpr std::uint32_t kRings = 37, kCorners = 4;
  constexpr float kHalf = 0.16F;
  Shape shape;
  std::vector<glm::vec3> places;
  // Corners are there twice, so that the sides stay flat.
  for (std::uint32_t side = 0; side < kCorners; ++side) {
    for (std::uint32_t ring = 0; ring < kRings; ++ring) {
      const float up = kBarJoints * kBarStep * static_cast<float>(ring) / (kRings - 1);
      for (const std::uint32_t corner : {side, side + 1}) {
        const float angle = glm::radians(45.0F + 90.0F * static_cast<float>(corner));
        places.emplace_back(kHalf * std::sqrt(2.0F) * std::sin(angle), up, kHalf * std::sqrt(2.0F) * std::cos(angle));
        const float joint = std::clamp(up / kBarStep - 0.5F, 0.0F, static_cast<float>(kBarJoints) - 1.0F);
        const float lower = std::min(std::floor(joint), static_cast<float>(kBarJoints) - 2.0F);
        const float share = joint - lower, smooth = share * share * (3.0F - 2.0F * share);
        const auto first = static_cast<std::uint16_t>(lower);
        for (const std::uint16_t e : {first, static_cast<std::uint16_t>(first + 1), std::uint16_t{0}, std::uint16_t{0}}) {
          shape.entries.push_back(e);
        }
        shape.entry_weights.insert(shape.entry_weights.end(), {1.0F - smooth, smooth, 0.0F, 0.0F});
      }
      if (ring == kRings - 1) continue;
      const std::uint32_t at = 2 * (side * kRings + ring);
      shape.indices.insert(shape.indices.end(), {at, at + 1, at + 3, at, at + 3, at + 2});
    }
  }
  const auto top = static_cast<std::uint32_t>(places.size());
  for (std::uint32_t side = 0; side < kCorners; ++side) {
    places.push_back(places[2 * (side * kRings + kRings - 1)]);
    shape.entries.insert(shape.entries.end(), {kBarJoints - 1, 0, 0, 0});
    shape.entry_weights.insert(shape.entry_weights.end(), {1, 0, 0, 0});
  }
  shape.indices.insert(shape.indices.end(), {top, top + 1, top + 2, top, top + 2, top + 3});
  shape.vertex_count = places.size();
  shape.influences = 4;
  shape.add_key(places, std::vector<glm::vec3>(places.size(), glm::vec3(0.0F)));
  set_normals(shape);
  shape.materials[0].base_color = {0.35F, 0.6F, 0.85F};
  return shape;
}

/// Where the bar's joints are when each bends against the one before.
std::vector<glm::mat4> bent(float angle) {
  std::vector<glm::mat4> model_from_joint;
  glm::mat4 at(1.0F);
  for (std::size_t i = 0; i < kBarJoints; ++i) {
    if (i > 0) at = glm::translate(at, glm::vec3(0.0F, kBarStep, 0.0F));
    at = glm::rotate(at, i == 0 ? 0.25F * angle : angle, glm::vec3(0.0F, 0.25F, -1.0F));
    model_from_joint.push_back(at);
  }
  return model_from_joint;
}

std::vector<Affine> palette_of(const std::vector<glm::mat4>& model_from_joint) {
  std::vector<Affine> palette;
  for (std::size_t i = 0; i < model_from_joint.size(); ++i) {
    const glm::mat4 joint_from_mesh = glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, -kBarStep * static_cast<float>(i), 0.0F));
    palette.push_back(animation::to_affine(model_from_joint[i] * joint_from_mesh));
  }
  return palette;
}

std::span<const float> floats_of(const std::vector<Affine>& palette) {
  return {&palette.front().rows[0].x, 12 * palette.size()};
}

BoneSource bone(const glm::vec3& parent, const glm::vec3& joint, float radius) {
  BoneSource source;
  source.joint = joint;
  source.parent = parent;
  source.radius = radius;
  if (parent == joint) return source;
  const glm::vec3 along = glm::normalize(joint - parent);
  source.side = glm::normalize(glm::cross(along, std::abs(along.z) < 0.9F ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0)));
  return source;
}

/// Each joint's parent, and where it is: a figure that waves.
std::vector<BoneSource> figure() {
  struct Joint {
    std::size_t parent;
    glm::vec3 at;
  };
  const std::vector<Joint> joints{
      {0, {0, 1.0F, 0}},         {0, {0, 1.25F, 0}},          {1, {0, 1.5F, 0.02F}},         {2, {0, 1.62F, 0.04F}},
      {3, {0, 1.85F, 0.06F}},    {2, {0.2F, 1.48F, 0}},       {5, {0.5F, 1.42F, 0}},         {6, {0.68F, 1.68F, 0.1F}},
      {7, {0.72F, 1.8F, 0.12F}}, {2, {-0.2F, 1.48F, 0}},      {9, {-0.38F, 1.25F, 0}},       {10, {-0.42F, 1.0F, 0.1F}},
      {0, {0.12F, 0.95F, 0}},    {12, {0.16F, 0.5F, 0.1F}},   {13, {0.16F, 0.06F, -0.04F}},  {14, {0.17F, 0.0F, 0.12F}},
      {0, {-0.12F, 0.95F, 0}},   {16, {-0.15F, 0.5F, 0.04F}}, {17, {-0.16F, 0.06F, -0.05F}}, {18, {-0.17F, 0.0F, 0.11F}}};
  std::vector<BoneSource> bones;
  for (const Joint& joint : joints) {
    const glm::vec3& parent = joints[joint.parent].at;
    bones.push_back(bone(parent, joint.at, 0.05F * std::clamp(glm::length(joint.at - parent), 0.2F, 0.45F)));
  }
  return bones;
}

/// A ball with a nose, and three targets: a smile, raised brows, a longer nose. Painted by the colours of its vertices.
struct Face {
  Shape shape = test::ball(64, 96);
  std::array<std::vector<float>, 3> targets;
  std::array<std::vector<float>, 3> normals;

  Face() {
    shape.texcoords.clear();
    std::vector<float>& block = shape.blocks[0];
    block.resize(6 * shape.vertex_count);
    for (std::vector<float>& target : targets) target.resize(3 * shape.vertex_count);
    for (std::size_t v = 0; v < shape.vertex_count; ++v) {
      float* p = block.data() + 3 * v;
      const glm::vec3 at(p[0], p[1], p[2]);
      const auto near = [&](float x, float y, float wide, float high) {
        const float dx = (std::abs(at.x) - x) / wide, dy = (at.y - y) / high;
        return at.z > 0.0F ? std::exp(-dx * dx - dy * dy) : 0.0F;
      };
      const float nose = near(0.0F, 0.0F, 0.13F, 0.2F);
      const float corner = near(0.33F, -0.38F, 0.16F, 0.14F), mouth = near(0.0F, -0.42F, 0.38F, 0.06F);
      const float brow = near(0.34F, 0.42F, 0.2F, 0.08F), eye = near(0.34F, 0.2F, 0.1F, 0.1F);
      p[2] += 0.25F * nose - 0.05F * mouth;
      const std::array<glm::vec3, 3> moves{glm::vec3(0.12F * corner * at.x, 0.16F * corner, 0.1F * corner),
                                           glm::vec3(0.0F, 0.13F * brow, 0.08F * brow), glm::vec3(0.0F, -0.1F, 0.5F) * nose};
      for (std::size_t t = 0; t < 3; ++t) {
        for (int k = 0; k < 3; ++k) targets[t][3 * v + static_cast<std::size_t>(k)] = moves[t][k];
      }
      glm::vec3 color(0.85F, 0.55F, 0.32F);
      color = glm::mix(color, glm::vec3(0.55F, 0.05F, 0.06F), std::min(1.0F, 1.3F * mouth));
      color = glm::mix(color, glm::vec3(0.03F, 0.04F, 0.08F), std::min(1.0F, 1.5F * std::max(eye * eye, brow * brow)));
      shape.colors.insert(shape.colors.end(), {color.x, color.y, color.z, 1.0F});
    }
    set_normals(shape);
    add_normals();
    for (std::size_t t = 0; t < 3; ++t) shape.morphs.push_back({0, targets[t], normals[t]});
  }
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;

  /// What each target makes of the normals, as their displacement.
  void add_normals() {
    const std::size_t stream = 3 * shape.vertex_count;
    for (std::size_t t = 0; t < 3; ++t) {
      std::vector<float> moved(shape.blocks[0].begin(), shape.blocks[0].begin() + static_cast<std::ptrdiff_t>(stream));
      for (std::size_t i = 0; i < stream; ++i) moved[i] += targets[t][i];
      normals[t].resize(stream);
      EXPECT_TRUE(animation::compute_normals(moved, shape.indices, normals[t]));
      for (std::size_t i = 0; i < stream; ++i) normals[t][i] -= shape.blocks[0][stream + i];
    }
  }
};

class GoldenPosed : public testing::Test {
 protected:
  [[nodiscard]] Picture bar_picture() const {
    Picture picture = studio({1.6F, 1.9F, 3.0F}, {0.55F, 0.85F, 0.0F});
    DrawItem item = bar_.item();
    item.palette = floats_of(palette_);
    picture.items = {item};
    picture.grid = true;
    return picture;
  }
  [[nodiscard]] Picture face_picture(const std::vector<float>& left, const std::vector<float>& right) const {
    Picture picture = studio({0.0F, 0.3F, 5.6F}, {0.0F, 0.0F, 0.0F});
    for (const auto& [weights, x, turn] : {std::tuple{&left, -1.25F, 0.35F}, std::tuple{&right, 1.25F, -0.35F}}) {
      DrawItem item = face_.shape.item();
      item.morph_weights = *weights;
      item.world_from_model =
          glm::rotate(glm::translate(glm::mat4(1.0F), glm::vec3(x, 0.0F, 0.0F)), turn, glm::vec3(0.0F, 1.0F, 0.0F));
      picture.items.push_back(item);
    }
    return picture;
  }
  const Shape bar_ = bar();
  const std::vector<glm::mat4> joints_ = bent(0.5F);
  const std::vector<Affine> palette_ = palette_of(joints_);
  const Face face_;
  test::Offscreen gpu_;
};

TEST_F(GoldenPosed, ABarBentByItsSkin) { test::expect_golden("bar_bent", gpu_.draw(bar_picture())); }

TEST_F(GoldenPosed, ItsSkeletonIsSeenThroughIt) {
  Picture picture = bar_picture();
  for (std::size_t i = 0; i < kBarJoints; ++i) {
    picture.bones_over.push_back(bone(glm::vec3(joints_[i == 0 ? 0 : i - 1][3]), glm::vec3(joints_[i][3]), 0.04F));
  }
  test::expect_golden("bar_skeleton", gpu_.draw(picture));
}

TEST_F(GoldenPosed, AFaceAtRestAndOneThatMorphs) {
  const std::vector<float> rest{0, 0, 0}, smiling{1.0F, 0.8F, 0.6F};
  test::expect_golden("face_morphed", gpu_.draw(face_picture(rest, smiling)));
}

TEST_F(GoldenPosed, BonesOfAFigureOnTheGround) {
  Picture picture = studio({0.9F, 1.3F, 2.6F}, {0.1F, 0.95F, 0.0F});
  picture.bones = figure();
  picture.grid = true;
  test::expect_golden("figure_bones", gpu_.draw(picture));
}

TEST_F(GoldenPosed, CutOutUnlitAndColouredByVertices) {
  constexpr std::uint32_t kTexels = 64;
  std::vector<std::uint8_t> ring;
  for (std::uint32_t y = 0; y < kTexels; ++y) {
    for (std::uint32_t x = 0; x < kTexels; ++x) {
      const double from = std::hypot(x - 31.5, y - 31.5);
      const auto alpha = static_cast<std::uint8_t>(std::clamp(128.0 + 40.0 * (10.0 - std::abs(from - 20.0)), 0.0, 255.0));
      for (const std::uint32_t c : {230U, 90U + 2 * x, 30U + 3 * y}) ring.push_back(static_cast<std::uint8_t>(c));
      ring.push_back(alpha);
    }
  }
  const TextureSource texture{{77, 1}, {kTexels, kTexels}, ring};
  std::vector<Shape> shapes;
  for (const bool unlit : {false, true}) {
    Shape& shape = shapes.emplace_back(test::square(0.9F));
    shape.materials[0] = {glm::vec3(1.0F), texture};
    shape.materials[0].alpha_cutoff = 0.5F;
    shape.materials[0].unlit = unlit;
    // Of one and a half rings each way: mirrored across, the last ones dragged out upwards.
    for (float& t : shape.texcoords) t *= 1.5F;
    shape.materials[0].wrap_u = TextureWrap::MirroredRepeat;
    shape.materials[0].wrap_v = TextureWrap::ClampToEdge;
  }
  Shape& painted = shapes.emplace_back(test::ball(48, 64));
  for (std::size_t v = 0; v < painted.vertex_count; ++v) {
    const float* p = painted.blocks[0].data() + 3 * v;
    painted.colors.insert(painted.colors.end(),
                          {0.5F + 0.5F * p[0], 0.5F + 0.5F * p[1], 0.5F + 0.5F * std::sin(6.0F * p[1]), 1.0F});
  }
  Picture picture = studio({0.0F, 1.2F, 6.4F}, {0.0F, 0.75F, 0.0F});
  picture.grid = true;
  float x = -2.0F;
  for (const Shape& shape : shapes) {
    DrawItem item = shape.item();
    item.world_from_model =
        glm::rotate(glm::translate(glm::mat4(1.0F), glm::vec3(x, 0.95F, 0.0F)), -0.25F * x, glm::vec3(0.0F, 1.0F, 0.0F));
    picture.items.push_back(item);
    x += 2.0F;
  }
  test::expect_golden("materials", gpu_.draw(picture));
}

}  // namespace
}  // namespace tweend::render
