#include "render/bone_drawer.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "render/gpu_mesh.hpp"
#include "render/shader_sources.hpp"

namespace tweend::render {
namespace {

// sRGB: apart from each other, from the default blue of meshes, and from skin.
constexpr glm::vec3 kBoneColor{0.93F, 0.90F, 0.78F};
constexpr glm::vec3 kJointColor{1.0F, 0.55F, 0.1F};

/// Where along a bone, and how far from its middle, its widest corners are; its length is 1.
constexpr float kWaist = 0.15F;
constexpr float kHalfWidth = 0.1F;

constexpr int kRings = 8;
constexpr int kSegments = 14;

/// A vertex as shaders/bone.vert reads it.
struct ShapeVertex {
  glm::vec3 position;
  glm::vec3 normal;
  float is_bone;
};

void add_octahedron(std::vector<ShapeVertex>& shapes) {
  const std::array<glm::vec3, 4> corners{
      {{kHalfWidth, kWaist, 0.0F}, {0.0F, kWaist, -kHalfWidth}, {-kHalfWidth, kWaist, 0.0F}, {0.0F, kWaist, kHalfWidth}}};
  const auto face = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    for (const glm::vec3& corner : {a, b, c}) shapes.push_back({corner, normal, 1.0F});
  };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::vec3& next = corners[(i + 1) % corners.size()];
    face({0.0F, 1.0F, 0.0F}, corners[i], next);
    face({0.0F, 0.0F, 0.0F}, next, corners[i]);
  }
}

glm::vec3 on_ball(int ring, int segment) {
  const float up = glm::pi<float>() * static_cast<float>(ring) / kRings;
  const float round = glm::two_pi<float>() * static_cast<float>(segment) / kSegments;
  return {std::sin(up) * std::sin(round), -std::cos(up), std::sin(up) * std::cos(round)};
}

void add_ball(std::vector<ShapeVertex>& shapes) {
  const auto add = [&](int ring, int segment) {
    const glm::vec3 at = on_ball(ring, segment);
    shapes.push_back({at, at, 0.0F});
  };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int segment = 0; segment < kSegments; ++segment) {
      if (ring > 0) {
        add(ring, segment);
        add(ring, segment + 1);
        add(ring + 1, segment + 1);
      }
      if (ring == kRings - 1) continue;
      add(ring, segment);
      add(ring + 1, segment + 1);
      add(ring + 1, segment);
    }
  }
}

void add_attribute(GLuint array, GLuint at, GLint floats, std::size_t offset, GLuint binding) {
  glEnableVertexArrayAttrib(array, at);
  glVertexArrayAttribFormat(array, at, floats, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, at, binding);
}

}  // namespace

Status BoneDrawer::link() {
  TWEEND_ASSIGN(program_, ShaderProgram::link({shaders::kFrame, shaders::kBoneVert},
                                              {shaders::kFrame, shaders::kLight, shaders::kBoneFrag}));
  program_.set(program_.location("bone_color"), linear_from_srgb(kBoneColor));
  program_.set(program_.location("joint_color"), linear_from_srgb(kJointColor));
  upload_shapes();
  return {};
}

void BoneDrawer::upload_shapes() {
  std::vector<ShapeVertex> shapes;
  add_octahedron(shapes);
  add_ball(shapes);
  vertex_count_ = static_cast<GLsizei>(shapes.size());
  glNamedBufferStorage(shapes_.name(), static_cast<GLsizeiptr>(shapes.size() * sizeof(ShapeVertex)), shapes.data(), 0);
  const GLuint array = vertex_array_.name();
  glVertexArrayVertexBuffer(array, 0, shapes_.name(), 0, sizeof(ShapeVertex));
  add_attribute(array, 0, 3, offsetof(ShapeVertex, position), 0);
  add_attribute(array, 1, 3, offsetof(ShapeVertex, normal), 0);
  add_attribute(array, 2, 1, offsetof(ShapeVertex, is_bone), 0);
  // The ball's radius follows the joint's place: both make one attribute.
  static_assert(offsetof(BoneSource, radius) == offsetof(BoneSource, joint) + sizeof(glm::vec3));
  add_attribute(array, 3, 4, offsetof(BoneSource, joint), 1);
  add_attribute(array, 4, 3, offsetof(BoneSource, parent), 1);
  add_attribute(array, 5, 3, offsetof(BoneSource, side), 1);
  glVertexArrayBindingDivisor(array, 1, 1);
}

void BoneDrawer::draw(std::span<const BoneSource> bones, FrameMemory& memory) const {
  if (bones.empty()) return;
  const FrameMemory::Piece piece = memory.take(bones.size_bytes());
  if (piece.memory.empty()) return;
  std::memcpy(piece.memory.data(), bones.data(), bones.size_bytes());
  program_.use();
  glVertexArrayVertexBuffer(vertex_array_.name(), 1, piece.buffer, piece.offset, sizeof(BoneSource));
  glBindVertexArray(vertex_array_.name());
  glDrawArraysInstanced(GL_TRIANGLES, 0, vertex_count_, static_cast<GLsizei>(bones.size()));
}

}  // namespace tweend::render
