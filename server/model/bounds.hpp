#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace tweend::model {

/// An axis-aligned box, metres.
struct Bounds {
  glm::vec3 min{0.0F};
  glm::vec3 max{0.0F};
  bool operator==(const Bounds&) const = default;
};

/// The smallest box around both.
[[nodiscard]] inline Bounds joined(const Bounds& a, const Bounds& b) noexcept {
  return {glm::min(a.min, b.min), glm::max(a.max, b.max)};
}

}  // namespace tweend::model
