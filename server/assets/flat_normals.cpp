#include "server/assets/flat_normals.hpp"

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace tweend::assets {
namespace {

constexpr double kSameDirection = 1e-3;
constexpr std::uint32_t kNone = UINT32_MAX;

glm::dvec3 position(std::span<const float> positions, std::uint32_t vertex) {
  const std::size_t at = std::size_t{3} * vertex;
  return {positions[at], positions[at + 1], positions[at + 2]};
}

/// Nothing of an empty triangle.
std::optional<glm::vec3> normal_of(std::span<const float> positions, const std::uint32_t* corners) {
  const glm::dvec3 a = position(positions, corners[0]);
  const glm::dvec3 normal = glm::cross(position(positions, corners[1]) - a, position(positions, corners[2]) - a);
  const double length = glm::length(normal);
  if (!(length > 0.0) || !std::isfinite(length)) return std::nullopt;
  return glm::vec3(normal / length);
}

}  // namespace

FlatNormals compute_flat_normals(std::span<const float> positions, std::span<std::uint32_t> indices) {
  const std::size_t vertices = positions.size() / 3;
  FlatNormals flat;
  std::vector<std::optional<glm::vec3>> normals(vertices);
  std::vector<std::uint32_t> next(vertices, kNone);  // the next vertex at the same place, with another normal
  for (std::size_t corner = 0; corner < indices.size(); corner += 3) {
    const std::uint32_t corners[] = {indices[corner], indices[corner + 1], indices[corner + 2]};
    const std::optional<glm::vec3> normal = normal_of(positions, corners);
    if (!normal) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint32_t at = corners[i];
      while (normals[at] && glm::distance(*normals[at], *normal) > kSameDirection) {
        if (next[at] == kNone) {
          next[at] = static_cast<std::uint32_t>(normals.size());
          flat.copies.push_back(corners[i]);
          normals.emplace_back();
          next.push_back(kNone);
        }
        at = next[at];
      }
      if (!normals[at]) normals[at] = normal;
      indices[corner + i] = at;
    }
  }
  flat.normals.reserve(3 * normals.size());
  for (const auto& normal : normals) {
    const glm::vec3 n = normal.value_or(glm::vec3(0, 1, 0));
    flat.normals.insert(flat.normals.end(), {n.x, n.y, n.z});
  }
  return flat;
}

}  // namespace tweend::assets
