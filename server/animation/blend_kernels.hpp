#pragma once

#include <array>
#include <cstddef>

namespace tweend::animation {

/// One stream of floats to blend. Nothing is checked here; blend_vertices does that.
struct StreamBlend {
  std::array<const float*, 4> source{};
  std::array<float, 4> weight{};
  std::size_t source_count = 0;  ///< 1 to 4
  std::size_t nearest = 0;       ///< index into source; read by blend_directions only
  float* out = nullptr;
  std::size_t size = 0;  ///< floats in each source and in out
};

/// A blended direction below this length counts as none. Unit vectors that cancel out leave rounding errors of about
/// 1e-8, whose direction means nothing.
inline constexpr float kShortestDirection = 1e-6F;

/// out[i] = Σ weight[s] · source[s][i].
void blend_values(const StreamBlend& blend) noexcept;

/// The same for xyz triples, scaled to unit length; those without one are source[nearest]'s.
/// size is a multiple of 3.
void blend_directions(const StreamBlend& blend) noexcept;

}  // namespace tweend::animation
