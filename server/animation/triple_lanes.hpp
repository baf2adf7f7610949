#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tweend::animation {

/// Where x, y and z sit in three vectors a, b, c of `kLanes` floats that hold kLanes interleaved triples, e.g. for four
/// lanes: x0 y0 z0 x1 | y1 z1 x2 y2 | z2 x3 y3 z3.
///
/// kLanes is no multiple of 3, so the lanes of one component never coincide: x sits in lanes 0 3 | 2 | 1. Three masks
/// by lane mod 3 thus gather a component into one vector without moving anything; its order of vertices is its own.
template <std::size_t kLanes>
struct TripleLanes {
  static_assert(kLanes % 3 != 0);
  using Lanes = std::array<std::int32_t, kLanes>;

  std::array<Lanes, 3> is_residue{};  ///< [r][lane]: all bits set where lane % 3 == r, else 0
  Lanes vertex{};                     ///< the vertex whose x stands in this lane once gathered
  Lanes y_beside_x{};                 ///< lane of the gathered y (z) that belongs to that vertex
  Lanes z_beside_x{};
  std::array<Lanes, 3> x_of{};  ///< [vector][lane]: lane of the gathered x of the vertex that this float belongs to

  constexpr TripleLanes() {
    for (std::size_t stream = 0; stream < 3 * kLanes; ++stream) {
      const std::size_t lane = stream % kLanes;
      x_of[stream / kLanes][lane] = gathered_lane(stream / 3, 0);
      if (stream % 3 == 0) {
        vertex[lane] = static_cast<std::int32_t>(stream / 3);
        y_beside_x[lane] = gathered_lane(stream / 3, 1);
        z_beside_x[lane] = gathered_lane(stream / 3, 2);
      }
      is_residue[lane % 3][lane] = -1;
    }
  }

  /// lane % 3 of `component` in vector 0 (a), 1 (b) or 2 (c).
  static constexpr std::size_t residue(std::size_t component, std::size_t vector) {
    return (component + 3 * kLanes - vector * kLanes) % 3;
  }

 private:
  static constexpr std::int32_t gathered_lane(std::size_t vertex_index, std::size_t component) {
    return static_cast<std::int32_t>((3 * vertex_index + component) % kLanes);
  }
};

}  // namespace tweend::animation
