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

/// What a texture shows beyond its edges.
enum class TextureWrap : std::uint8_t { Repeat, MirroredRepeat, ClampToEdge };

struct MaterialSource {
  glm::vec3 base_color{1.0F};  ///< sRGB, 0 to 1; multiplies the texture in linear light
  std::optional<TextureSource> base_color_texture{};
  TextureWrap wrap_u = TextureWrap::Repeat;
  TextureWrap wrap_v = TextureWrap::Repeat;
  float alpha = 1.0F;                   ///< multiplies the texture's
  std::optional<float> alpha_cutoff{};  ///< what has less alpha is not drawn; empty: all is, opaque
  bool unlit = false;                   ///< shows its colour as it is
};

/// A run of triangles that show one material.
struct PartSource {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
  std::uint32_t material = 0;
};

/// Which entries of a palette of matrices move each vertex, and how much.
struct SkinSource {
  std::size_t per_vertex = 0;              ///< influences a vertex: 1, 4 or 8; 0: there is no skin
  std::span<const std::uint16_t> entries;  ///< shape [vertex_count × per_vertex]
  std::span<const float> weights;          ///< the same shape, sum 1 a vertex; not looked at with one influence
};

/// How a morph target displaces a run of vertices at weight 1.
struct MorphSource {
  std::size_t first_vertex = 0;
  std::span<const float> positions;  ///< shape [run × 3], metres
  std::span<const float> normals;    ///< the same shape, or empty
};

/// What all keyframes of a mesh share.
struct MeshSource {
  ResourceId id;
  std::size_t vertex_count = 0;
  std::span<const std::uint32_t> indices;  ///< three a triangle, counter-clockwise fronts
  std::span<const float> texcoords;        ///< shape [vertex_count × 2], v upwards; or empty
  std::span<const float> colors;           ///< shape [vertex_count × 4], linear RGBA, multiplies the base colour; or empty
  SkinSource skin;
  std::vector<MorphSource> morphs;
  std::vector<MaterialSource> materials;  ///< at least one
  std::vector<PartSource> parts;          ///< all triangles, each once
  std::shared_ptr<const void> owner;      ///< keeps the spans alive
};
using MeshSourcePtr = std::shared_ptr<const MeshSource>;

/// One keyframe's vertices: a block of positions, then unit normals, then, where the mesh has texture coordinates, unit
/// tangents; each shape [vertex_count × 3], model space.
struct KeySource {
  ResourceId id;
  std::span<const float> block;
};

/// A mesh at one moment, in one of three ways: Σ weight[i] · key[i] of up to four keyframes, blended by the vertex shader; one
/// keyframe that is then morphed and skinned there; or vertices that belong to no keyframe.
struct DrawItem {
  MeshSourcePtr mesh;
  std::uint32_t key_count = 1;  ///< 1 to 4; with a palette or morph weights: 1
  std::array<KeySource, 4> key;
  std::array<float, 4> weight{1.0F, 0.0F, 0.0F, 0.0F};
  std::uint32_t nearest = 0;      ///< whose normal stands in where the blended one has no length
  std::size_t keys_expected = 1;  ///< how many keyframes of this mesh there are to come: room for them is made at once
  /// Shape [entries × 12]: of each entry's matrix the three rows but the last. Empty: the skin is left aside.
  std::span<const float> palette;
  std::span<const float> morph_weights;  ///< one for each of the mesh's morph targets; empty: all 0
  /// Laid out as a keyframe's block, and uploaded for this picture alone; not empty: they stand in for the keyframes.
  std::span<const float> vertices;
  glm::mat4 world_from_model{1.0F};
};

/// A joint, drawn as a small ball, and the bone that leads to it from its parent, as an octahedron. World space, metres.
struct BoneSource {
  glm::vec3 joint{0.0F};
  float radius = 0.0F;     ///< of the ball
  glm::vec3 parent{0.0F};  ///< where `joint` is: there is no bone
  float padding0 = 0.0F;
  glm::vec3 side{1.0F, 0.0F, 0.0F};  ///< unit, across the bone: how it is turned about itself
  float padding1 = 0.0F;
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
  std::vector<BoneSource> bones;       ///< hidden by what stands before them
  std::vector<BoneSource> bones_over;  ///< seen through everything but each other
};

}  // namespace tweend::render
