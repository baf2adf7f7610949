#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace tweend::protocol {

/// Axis-aligned; zeros where there is nothing.
struct Bounds {
  std::array<float, 3> min{};
  std::array<float, 3> max{};
};

/// Coordinates are taken within ± this, so that an extent is a float32; NaN for 0. Normals that are not finite for zero ones.
inline constexpr float kFarthest = std::numeric_limits<float>::max() / 2.0F;

/// @param positions  shape [n × 3]
[[nodiscard]] Bounds bounds_of(std::span<const float> positions) noexcept;

inline constexpr int kPositionMost = 65535;
inline constexpr int kFineNormalBits = 16;
inline constexpr int kShortNormalBits = 12;

/// Sixteen bits a coordinate, evenly over a box: position = min + integer · extent / 65535.
struct PositionGrid {
  PositionGrid() = default;
  /// Over `bounds`, which lie within ± kFarthest.
  explicit PositionGrid(const Bounds& bounds) noexcept;

  std::array<float, 3> min{};
  std::array<float, 3> extent{};

  /// In double, so that reading adds nothing but the rounding to float32.
  [[nodiscard]] float position(std::size_t axis, std::uint16_t integer) const noexcept {
    return static_cast<float>(double{min[axis]} + integer * (double{extent[axis]} / kPositionMost));
  }
};

/// Integers of n vertices, each coordinate for itself.
struct VertexPlanes {
  static constexpr std::size_t kCount = 5;     ///< positions xyz, octahedral normals xy
  std::array<std::uint16_t*, kCount> plane{};  ///< shape [n] each; normals hold int16's bits
};

/// Positions cut to the grid; normals octahedral at kShortNormalBits, zero ones as its kNone. Values don't depend on the
/// machine's vector unit, nor on a vertex's place. Any thread.
/// @param positions  shape [n × 3]
/// @param normals    shape [n × 3], unit length or zero
void quantise_to_planes(std::span<const float> positions, std::span<const float> normals, const PositionGrid& grid,
                        const VertexPlanes& out) noexcept;

/// The same with normals at kFineNormalBits, all positions and then all normals.
/// @param out_positions  shape [n × 3], unaligned
/// @param out_normals    shape [n × 2], unaligned
void quantise_interleaved(std::span<const float> positions, std::span<const float> normals, const PositionGrid& grid,
                          std::byte* out_positions, std::byte* out_normals) noexcept;

}  // namespace tweend::protocol
