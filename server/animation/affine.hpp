#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace tweend::animation {

/// An affine matrix without its last row (0 0 0 1): three rows, each to be multiplied with (x, y, z, 1).
struct alignas(16) Affine {
  std::array<glm::vec4, 3> rows{glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0)};
  bool operator==(const Affine&) const = default;
};

/// The last row of `matrix` is not looked at.
[[nodiscard]] Affine to_affine(const glm::mat4& matrix) noexcept;
[[nodiscard]] glm::mat4 to_mat4(const Affine& affine) noexcept;
/// a · b: first b, then a.
[[nodiscard]] Affine multiply(const Affine& a, const Affine& b) noexcept;

}  // namespace tweend::animation
