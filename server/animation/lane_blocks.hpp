#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "server/animation/pose.hpp"
#include "server/animation/segment_blend.hpp"
#include "server/animation/track.hpp"

// What TrackSet is made of: vectors of kPoseLanes channels that are blended side by side. A channel's lane is its target's lane
// in the pose, so that results are stored as they come and nothing is scattered.

namespace tweend::animation {

constexpr std::size_t components_of(Property property) noexcept {
  return property == Property::Rotation ? 4 : property == Property::Weight ? 1 : 3;
}

/// kPoseLanes channels of one property beside each other.
struct LaneBlock {
  alignas(64) std::array<std::int32_t, kPoseLanes> covered{};  ///< all bits set where there is a track; other lanes stay
  Property property = Property::Translation;
  bool is_full = false;            ///< all are covered
  std::uint32_t first_target = 0;  ///< a multiple of kPoseLanes
  std::uint32_t offset = 0;        ///< of its first component in a key, in vectors
};

/// Where a pose keeps its floats.
struct PoseFloats {
  explicit PoseFloats(Pose& pose) noexcept
      : rows(pose.row(PoseRow::Tx).data()), stride(pose.stride()), weights(pose.weights().data()) {}
  /// The first component of kPoseLanes channels; others follow at component_stride().
  [[nodiscard]] float* first(const LaneBlock& block) const noexcept {
    constexpr std::array kFirstRow{PoseRow::Tx, PoseRow::Rx, PoseRow::Sx};
    if (block.property == Property::Weight) return weights + block.first_target;
    return rows + static_cast<std::size_t>(kFirstRow[static_cast<std::size_t>(block.property)]) * stride + block.first_target;
  }
  float* rows;
  std::size_t stride;
  float* weights;
};

/// Blocks whose tracks share times and modes, between keys (or tangents) that are laid out alike.
struct SheetBlend {
  SegmentBlend::Kind kind = SegmentBlend::Kind::Hold;
  std::array<const Lanes*, 4> source{};  ///< those that the kind wants
  std::array<float, 4> weight{};
};
void blend_sheet(const SheetBlend& blend, std::span<const LaneBlock> blocks, const PoseFloats& out) noexcept;

/// One block whose tracks have times and modes of their own: each lane has its sources and weights side by side.
struct LooseBlend {
  std::array<std::array<Lanes, 4>, 4> source;  ///< [source][component]; rotations already in one hemisphere, but for slerps
  std::array<Lanes, 4> weight;                 ///< [source]
  alignas(64) std::array<std::int32_t, kPoseLanes> is_slerp;  ///< all bits set where weights 0 and 1 are to be those of a slerp
  alignas(64) std::array<std::int32_t, kPoseLanes> is_unit;   ///< all bits set where the sum is to be scaled to unit length
};
void blend_loose(const LooseBlend& blend, const LaneBlock& block, const PoseFloats& out) noexcept;

}  // namespace tweend::animation
