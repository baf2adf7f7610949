#pragma once

#include <glm/vec3.hpp>

namespace tweend::model {

/// An axis-aligned box, metres.
struct Bounds {
  glm::vec3 min{0.0F};
  glm::vec3 max{0.0F};
  bool operator==(const Bounds&) const = default;
};

}  // namespace tweend::model
