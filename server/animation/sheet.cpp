#include "server/animation/sheet.hpp"

#include <algorithm>

namespace tweend::animation {
namespace {

bool is_zero(std::span<const glm::vec4> values) {
  return std::ranges::all_of(values, [](const glm::vec4& v) { return v == glm::vec4(0.0F); });
}

bool starts_block(const LaneBlock& last, const Channel& channel) {
  return last.property != channel.property || channel.target - last.first_target >= kPoseLanes;
}

/// The tracks' lanes, those of a block one after the other.
std::vector<LaneBlock> blocks_for(std::span<const TrackSource* const> tracks) {
  std::vector<LaneBlock> blocks;
  std::size_t vectors = 0;
  for (const TrackSource* track : tracks) {
    const Channel& channel = track->channel;
    if (blocks.empty() || starts_block(blocks.back(), channel)) {
      const auto first = static_cast<std::uint32_t>(channel.target - channel.target % kPoseLanes);
      blocks.push_back({.property = channel.property, .first_target = first, .offset = static_cast<std::uint32_t>(vectors)});
      vectors += components_of(channel.property);
    }
    blocks.back().covered[channel.target % kPoseLanes] = -1;
  }
  for (LaneBlock& block : blocks) block.is_full = std::ranges::count(block.covered, -1) == kPoseLanes;
  return blocks;
}

}  // namespace

std::size_t sheet_lanes(std::span<const TrackSource* const> tracks) { return blocks_for(tracks).size() * kPoseLanes; }

Sheet::Sheet(std::span<const TrackSource* const> tracks)
    : times_s_(tracks.front()->times_s.begin(), tracks.front()->times_s.end()),
      modes_(tracks.front()->modes.begin(), tracks.front()->modes.end()),
      blocks_(blocks_for(tracks)),
      key_stride_(blocks_.back().offset + components_of(blocks_.back().property)),
      values_(packed(tracks, &TrackSource::values)) {
  const auto has = [&](std::span<const glm::vec4> TrackSource::*stream) {
    return std::ranges::any_of(tracks, [&](const TrackSource* track) { return !is_zero(track->*stream); });
  };
  if (!has(&TrackSource::in_tangents) && !has(&TrackSource::out_tangents)) return;
  in_tangents_ = packed(tracks, &TrackSource::in_tangents);
  out_tangents_ = packed(tracks, &TrackSource::out_tangents);
}

std::vector<Lanes> Sheet::packed(std::span<const TrackSource* const> tracks,
                                 std::span<const glm::vec4> TrackSource::*stream) const {
  std::vector<Lanes> keys(times_s_.size() * key_stride_);
  auto block = blocks_.begin();
  for (const TrackSource* track : tracks) {
    if (starts_block(*block, track->channel)) ++block;
    const std::size_t lane = track->channel.target % kPoseLanes;
    const std::span<const glm::vec4> values = track->*stream;
    for (std::size_t key = 0; key < values.size(); ++key) {
      Lanes* at = &keys[key * key_stride_ + block->offset];
      for (std::size_t c = 0; c < components_of(block->property); ++c) at[c].lane[lane] = values[key][static_cast<int>(c)];
    }
  }
  return keys;
}

void Sheet::sample(double time_s, double duration_s, bool closed, Interpolation fallback,
                   const PoseFloats& out) const noexcept {
  const SegmentBlend segment = blend_segment({times_s_, duration_s, closed}, modes_, time_s, fallback);
  SheetBlend blend{.kind = segment.kind, .weight = segment.weight};
  for (std::size_t i = 0; i < 4; ++i) blend.source[i] = values_.data() + segment.key[i] * key_stride_;
  if (segment.kind == SegmentBlend::Kind::Cubic) {
    if (in_tangents_.empty()) {
      blend.weight[2] = blend.weight[3] = 0.0F;
    } else {
      blend.source[2] = out_tangents_.data() + segment.key[2] * key_stride_;
      blend.source[3] = in_tangents_.data() + segment.key[3] * key_stride_;
    }
  }
  blend_sheet(blend, blocks_, out);
}

}  // namespace tweend::animation
