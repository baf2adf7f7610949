#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <vector>

#include "render/picture.hpp"

namespace tweend::render::test {

/// A mesh and its keyframes in memory. Fill it in, then ask for what draws it; each shape has names of its own, so that
/// changing one after it was drawn takes a `rename()`.
struct Shape {
  Shape() { rename(); }
  void rename();

  std::size_t vertex_count = 0;
  std::vector<std::uint32_t> indices;
  std::vector<float> texcoords;               ///< shape [vertex_count × 2], or empty
  std::vector<float> colors;                  ///< shape [vertex_count × 4], or empty
  std::vector<std::vector<float>> blocks;     ///< one a keyframe, as KeySource has them
  std::vector<MaterialSource> materials{{}};  ///< white at first
  std::vector<PartSource> parts;              ///< empty: one part, material 0
  std::size_t influences = 0;                 ///< a vertex: 1, 4 or 8; 0: no skin
  std::vector<std::uint16_t> entries;         ///< shape [vertex_count × influences]
  std::vector<float> entry_weights;           ///< the same shape
  std::vector<MorphSource> morphs;            ///< of spans that last
  std::uint64_t name = 0;

  /// Adds a keyframe; tangents are +X, which light does not look at.
  void add_key(const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals);

  [[nodiscard]] MeshSourcePtr source() const;
  [[nodiscard]] KeySource key(std::size_t index) const;
  /// The shape between these of its keyframes, which stay the shape's.
  [[nodiscard]] DrawItem item(const std::vector<std::size_t>& keys = {0}, const std::vector<float>& weights = {1.0F}) const&;
  DrawItem item(const std::vector<std::size_t>& keys = {0}, const std::vector<float>& weights = {1.0F}) && = delete;
};

/// A square in the plane z = `z`, seen from +Z, from -half to half, with texture coordinates from 0 to 1.
/// @param normal  of all four corners
[[nodiscard]] Shape square(float half, float z = 0.0F, glm::vec3 normal = {0.0F, 0.0F, 1.0F});

/// A ball of radius 1 around the origin.
[[nodiscard]] Shape ball(std::uint32_t rings = 24, std::uint32_t segments = 48);

/// A keyframe's block of so many vertices: noise around the origin, unit directions, tangents if `textured`.
[[nodiscard]] std::vector<float> random_block(std::size_t vertex_count, bool textured, unsigned seed);

}  // namespace tweend::render::test
