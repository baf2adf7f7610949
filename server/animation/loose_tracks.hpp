#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "server/animation/lane_blocks.hpp"
#include "server/animation/track.hpp"

namespace tweend::animation {

/// Tracks with times or modes of their own. Each is looked up by itself; then up to kPoseLanes are blended side by side.
class LooseTracks {
 public:
  LooseTracks() = default;
  /// @param tracks  ordered by property, then target
  explicit LooseTracks(std::span<const TrackSource* const> tracks);

  void sample(double time_s, double duration_s, bool closed, Interpolation fallback, const PoseFloats& out) const noexcept;

 private:
  struct Track {
    std::size_t first_key = 0;  ///< in times_s_ and values_
    std::size_t key_count = 0;
    std::size_t first_mode = 0;
    std::size_t mode_count = 0;
    std::size_t first_in_tangent = 0;  ///< in tangents_; read only where has_…
    std::size_t first_out_tangent = 0;
    bool has_in_tangents = false;
    bool has_out_tangents = false;
    std::uint32_t lane = 0;
  };
  struct Group {
    LaneBlock block;
    std::vector<Track> tracks;
  };

  [[nodiscard]] Track stored(const TrackSource& source);
  void gather(const Track& track, const SegmentBlend& segment, Property property, LooseBlend& out) const noexcept;

  std::vector<Group> groups_;
  std::vector<double> times_s_;
  std::vector<glm::vec4> values_;
  std::vector<glm::vec4> tangents_;
  std::vector<KeyMode> modes_;
};

}  // namespace tweend::animation
