#include "server/animation/affine.hpp"

#include <glm/matrix.hpp>

namespace tweend::animation {

Affine to_affine(const glm::mat4& matrix) noexcept {
  const glm::mat4 rows = glm::transpose(matrix);
  return {{rows[0], rows[1], rows[2]}};
}

glm::mat4 to_mat4(const Affine& affine) noexcept {
  return glm::transpose(glm::mat4(affine.rows[0], affine.rows[1], affine.rows[2], glm::vec4(0, 0, 0, 1)));
}

Affine multiply(const Affine& a, const Affine& b) noexcept {
  Affine product;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec4& row = a.rows[i];
    product.rows[i] = row.x * b.rows[0] + row.y * b.rows[1] + row.z * b.rows[2] + glm::vec4(0, 0, 0, row.w);
  }
  return product;
}

}  // namespace tweend::animation
