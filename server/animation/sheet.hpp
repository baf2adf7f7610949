#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "server/animation/lane_blocks.hpp"
#include "server/animation/track.hpp"

namespace tweend::animation {

/// Tracks that share their times and modes, key after key: what one sample reads lies in one piece, or in two.
class Sheet {
 public:
  /// @param tracks  of the same times and modes, ordered by property, then target; at least one
  explicit Sheet(std::span<const TrackSource* const> tracks);

  void sample(double time_s, double duration_s, bool closed, Interpolation fallback, const PoseFloats& out) const noexcept;

 private:
  [[nodiscard]] std::vector<Lanes> packed(std::span<const TrackSource* const> tracks,
                                          std::span<const glm::vec4> TrackSource::*stream) const;

  std::vector<double> times_s_;
  std::vector<KeyMode> modes_;
  std::vector<LaneBlock> blocks_;
  std::size_t key_stride_ = 0;      ///< vectors a key
  std::vector<Lanes> values_;       ///< shape [keys × key_stride_]
  std::vector<Lanes> in_tangents_;  ///< the same; or empty: all zero
  std::vector<Lanes> out_tangents_;
};

/// How many lanes a sheet of these tracks has, used or not; each of them as wide as its property.
[[nodiscard]] std::size_t sheet_lanes(std::span<const TrackSource* const> tracks);

}  // namespace tweend::animation
