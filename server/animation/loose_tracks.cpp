#include "server/animation/loose_tracks.hpp"

#include <array>
#include <glm/geometric.hpp>

namespace tweend::animation {
namespace {

using Kind = SegmentBlend::Kind;

template <class T>
std::size_t append(std::vector<T>& all, std::span<const T> some) {
  all.insert(all.end(), some.begin(), some.end());
  return all.size() - some.size();
}

/// Turns the rotations around `from` (see SegmentBlend) into its hemisphere, by their weights.
void unite_hemispheres(const std::array<glm::vec4, 4>& source, std::array<float, 4>& weight) {
  const bool flips_to = glm::dot(source[0], source[1]) < 0.0F;
  const bool flips_next = (glm::dot(source[1], source[3]) < 0.0F) != flips_to;
  if (flips_to) weight[1] = -weight[1];
  if (glm::dot(source[0], source[2]) < 0.0F) weight[2] = -weight[2];
  if (flips_next) weight[3] = -weight[3];
}

}  // namespace

LooseTracks::LooseTracks(std::span<const TrackSource* const> tracks) {
  for (const TrackSource* track : tracks) {
    const Channel& channel = track->channel;
    const auto first = static_cast<std::uint32_t>(channel.target - channel.target % kPoseLanes);
    if (groups_.empty() || groups_.back().block.property != channel.property || groups_.back().block.first_target != first) {
      groups_.push_back({{.property = channel.property, .first_target = first}, {}});
    }
    groups_.back().block.covered[channel.target % kPoseLanes] = -1;
    groups_.back().tracks.push_back(stored(*track));
  }
}

LooseTracks::Track LooseTracks::stored(const TrackSource& source) {
  Track track;
  track.first_key = append(times_s_, source.times_s);
  track.key_count = source.times_s.size();
  append(values_, source.values);
  track.first_mode = append(modes_, source.modes);
  track.mode_count = source.modes.size();
  track.has_in_tangents = !source.in_tangents.empty();
  track.has_out_tangents = !source.out_tangents.empty();
  track.first_in_tangent = append(tangents_, source.in_tangents);
  track.first_out_tangent = append(tangents_, source.out_tangents);
  track.lane = static_cast<std::uint32_t>(source.channel.target % kPoseLanes);
  return track;
}

void LooseTracks::gather(const Track& track, const SegmentBlend& segment, Property property, LooseBlend& out) const noexcept {
  std::array<glm::vec4, 4> source{};
  std::array<float, 4> weight = segment.weight;
  const std::size_t values = segment.kind == Kind::Hold ? 1 : segment.kind == Kind::CatmullRom ? 4 : 2;
  for (std::size_t i = 0; i < values; ++i) source[i] = values_[track.first_key + segment.key[i]];
  if (segment.kind == Kind::Cubic) {
    if (track.has_out_tangents) source[2] = tangents_[track.first_out_tangent + segment.key[2]];
    if (track.has_in_tangents) source[3] = tangents_[track.first_in_tangent + segment.key[3]];
  }
  const bool is_rotation = property == Property::Rotation;
  if (is_rotation && segment.kind == Kind::CatmullRom) unite_hemispheres(source, weight);
  for (std::size_t i = 0; i < 4; ++i) {
    out.weight[i].lane[track.lane] = weight[i];
    for (std::size_t c = 0; c < components_of(property); ++c) {
      out.source[i][c].lane[track.lane] = source[i][static_cast<int>(c)];
    }
  }
  const bool is_blended = segment.kind == Kind::CatmullRom || segment.kind == Kind::Cubic;
  out.is_slerp[track.lane] = is_rotation && segment.kind == Kind::Linear ? -1 : 0;
  out.is_unit[track.lane] = is_rotation && is_blended ? -1 : 0;
}

void LooseTracks::sample(double time_s, double duration_s, bool closed, Interpolation fallback,
                         const PoseFloats& out) const noexcept {
  for (const Group& group : groups_) {
    LooseBlend blend{};
    for (const Track& track : group.tracks) {
      const std::span times = std::span(times_s_).subspan(track.first_key, track.key_count);
      const std::span modes = std::span(modes_).subspan(track.first_mode, track.mode_count);
      gather(track, blend_segment({times, duration_s, closed}, modes, time_s, fallback), group.block.property, blend);
    }
    blend_loose(blend, group.block, out);
  }
}

}  // namespace tweend::animation
