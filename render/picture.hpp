#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

// What is to be drawn, as values: spans and matrices, no clips and no clocks. Spans are borrowed; who asks for a picture
// keeps them alive until it is drawn.

namespace tweend::render {

/// Names immutable content: what has the same id is uploaded once.
struct ResourceId {
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  auto operator<=>(const ResourceId&) const = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 misreads it
};

/// Pixels of a picture.
struct Size {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool operator==(const Size&) const = default;
};

/// 8 bits a channel, RGBA, sRGB, top row first, rows without gaps.
struct TextureSource {
  ResourceId id;
  Size size;
  std::span<const std::uint8_t> rgba;
};

struct MaterialSource {
  glm::vec3 base_color{1.0F};  ///< sRGB, 0 to 1; multiplies the texture in linear light
  std::optional<TextureSource> base_color_texture;
};

/// A run of triangles that show one material.
struct PartSource {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
  std::uint32_t material = 0;
};

/// What all keyframes of a mesh share.
struct MeshSource {
  ResourceId id;
  std::size_t vertex_count = 0;
  std::span<const std::uint32_t> indices;  ///< three a triangle, counter-clockwise fronts
  std::span<const float> texcoords;        ///< shape [vertex_count × 2], v upwards; or empty
  std::vector<MaterialSource> materials;   ///< at least one
  std::vector<PartSource> parts;           ///< all triangles, each once
  std::shared_ptr<const void> owner;       ///< keeps the spans alive
};
using MeshSourcePtr = std::shared_ptr<const MeshSource>;

/// One keyframe's vertices: a block of positions, then unit normals, then, where the mesh has texture coordinates, unit
/// tangents; each shape [vertex_count × 3], model space.
struct KeySource {
  ResourceId id;
  std::span<const float> block;
};

/// A mesh between up to four of its keyframes: Σ weight[i] · key[i], blended by the vertex shader.
struct DrawItem {
  MeshSourcePtr mesh;
  std::uint32_t key_count = 1;  ///< 1 to 4
  std::array<KeySource, 4> key;
  std::array<float, 4> weight{1.0F, 0.0F, 0.0F, 0.0F};
  std::uint32_t nearest = 0;      ///< whose normal stands in where the blended one has no length
  std::size_t keys_expected = 1;  ///< how many keyframes of this mesh there are to come: room for them is made at once
  glm::mat4 world_from_model{1.0F};
};

/// One point light (intensities >= 0) and what shines from everywhere.
struct PointLight {
  glm::vec3 position{0.0F};  ///< world space, metres
  float ambient = 0.0F;
  float diffuse = 0.0F;
  float specular = 0.0F;
  float shininess = 1.0F;  ///< exponent, > 0
};

struct View {
  glm::mat4 view_from_world{1.0F};
  glm::mat4 clip_from_view{1.0F};  ///< OpenGL's clip space, -w <= z <= w
  glm::vec3 eye{0.0F};             ///< world space, metres
  float focus_m = 1.0F;            ///< how far away what is looked at stands: the grid's cells follow it
};

struct Picture {
  Size size;
  View view;
  PointLight light;
  glm::vec3 background{0.0F};  ///< sRGB, 0 to 1
  bool grid = false;           ///< the ground, y = 0
  std::vector<DrawItem> items;
};

}  // namespace tweend::render
