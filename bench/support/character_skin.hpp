#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "server/animation/skin_vertices.hpp"

namespace tweend::bench {

/// Random vertices under random matrices, four influences each, once as tweend keeps them and once as GLM code would.
struct CharacterSkin {
  CharacterSkin(std::size_t vertices, std::size_t joints);

  void skin_tweend();
  void skin_glm();
  /// The largest distance between what the two have made; normals as well.
  [[nodiscard]] double difference() const;

  std::vector<animation::Affine> palette;
  std::vector<std::uint16_t> entries;  ///< shape [vertices × 4]
  std::vector<float> weights;
  std::vector<float> in_positions, in_normals, out_positions, out_normals;

  std::vector<glm::mat4> glm_palette;
  std::vector<glm::vec3> glm_in_positions, glm_in_normals, glm_out_positions, glm_out_normals;
};

}  // namespace tweend::bench
