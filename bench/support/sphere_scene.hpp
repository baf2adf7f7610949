#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/stage/show.hpp"

// What the picture benchmarks draw: a sphere in the middle of the picture that grows lobes and loses them again.

namespace tweend::bench {

/// A sphere cut into `rings` bands of twice as many squares.
struct SphereGrid {
  std::uint32_t rings = 16;

  [[nodiscard]] std::size_t triangle_count() const noexcept { return std::size_t{4} * rings * rings; }
  /// Triangles, counter-clockwise seen from outside.
  [[nodiscard]] std::vector<std::uint32_t> indices() const;
  /// @param lobes  how far they stand out, of the radius; 0: a sphere
  [[nodiscard]] std::vector<float> positions(float lobes) const;
};

/// One actor on a clip of a second from the sphere (0 s) to its lobes (1 s), played there and back since the clock began.
[[nodiscard]] stage::SceneViewPtr playing_sphere(const SphereGrid& grid);

}  // namespace tweend::bench
