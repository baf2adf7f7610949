#include "bench/support/character_skin.hpp"

#include <algorithm>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <random>

namespace tweend::bench {

CharacterSkin::CharacterSkin(std::size_t vertices, std::size_t joints)
    : out_positions(3 * vertices), out_normals(3 * vertices), glm_out_positions(vertices), glm_out_normals(vertices) {
  std::mt19937 random(3);
  std::normal_distribution<float> noise;
  const auto vec3 = [&] { return glm::vec3(noise(random), noise(random), noise(random)); };
  for (std::size_t j = 0; j < joints; ++j) {
    glm::mat4 matrix = glm::mat4_cast(glm::normalize(glm::quat(2.0F, 0.4F * vec3())));
    matrix[3] = glm::vec4(0.2F * vec3(), 1.0F);
    glm_palette.push_back(matrix);
    palette.push_back(animation::to_affine(matrix));
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    glm_in_positions.push_back(vec3());
    glm_in_normals.push_back(glm::normalize(vec3()));
    for (int i = 0; i < 3; ++i) in_positions.push_back(glm_in_positions[v][i]), in_normals.push_back(glm_in_normals[v][i]);
    const float share[] = {0.4F, 0.3F, 0.2F, 0.1F};
    for (std::size_t i = 0; i < 4; ++i) {  // neighbours in a mesh hang on neighbours in the skeleton
      entries.push_back(static_cast<std::uint16_t>((v / 64 + i + random() % 3) % joints));
      weights.push_back(share[i]);
    }
  }
}

void CharacterSkin::skin_tweend() {
  const auto status = animation::skin_vertices({4, entries, weights}, palette, {in_positions, in_normals, {}},
                                               {out_positions, out_normals, {}});
  if (!status) std::abort();
}

void CharacterSkin::skin_glm() {
  for (std::size_t v = 0; v < glm_in_positions.size(); ++v) {
    glm::mat4 matrix(0.0F);
    for (std::size_t i = 4 * v; i < 4 * v + 4; ++i) matrix += weights[i] * glm_palette[entries[i]];
    glm_out_positions[v] = glm::vec3(matrix * glm::vec4(glm_in_positions[v], 1.0F));
    glm_out_normals[v] = glm::normalize(glm::transpose(glm::inverse(glm::mat3(matrix))) * glm_in_normals[v]);
  }
}

double CharacterSkin::difference() const {
  float worst = 0.0F;
  for (std::size_t v = 0; v < glm_in_positions.size(); ++v) {
    const auto at = [&](const std::vector<float>& all) { return glm::vec3(all[3 * v], all[3 * v + 1], all[3 * v + 2]); };
    worst = std::max(
        {worst, glm::distance(at(out_positions), glm_out_positions[v]), glm::distance(at(out_normals), glm_out_normals[v])});
  }
  return static_cast<double>(worst);
}

}  // namespace tweend::bench
