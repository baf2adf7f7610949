#include "server/animation/track.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "server/animation/key_timeline.hpp"
#include "server/animation/spline_weights.hpp"

namespace tweend::animation {
namespace {

struct Track {
  explicit Track(const TrackSource& source)
      : channel(source.channel),
        times_s(source.times_s.begin(), source.times_s.end()),
        values(source.values.begin(), source.values.end()),
        in_tangents(source.in_tangents.begin(), source.in_tangents.end()),
        out_tangents(source.out_tangents.begin(), source.out_tangents.end()),
        modes(source.modes.begin(), source.modes.end()) {}

  [[nodiscard]] const KeyMode& mode(std::size_t key) const { return modes[modes.size() == 1 ? 0 : key]; }

  Channel channel;
  std::vector<double> times_s;
  std::vector<glm::vec4> values;
  std::vector<glm::vec4> in_tangents;
  std::vector<glm::vec4> out_tangents;
  std::vector<KeyMode> modes;
};

/// The short way from a to b.
glm::dvec4 slerp(const glm::dvec4& a, glm::dvec4 b, double u) {
  if (glm::dot(a, b) < 0.0) b = -b;
  const double cosine = glm::dot(a, b);
  if (cosine > 1.0 - 1e-12) return glm::normalize(glm::mix(a, b, u));
  const double angle = std::acos(cosine);
  return (a * std::sin((1.0 - u) * angle) + b * std::sin(u * angle)) / std::sin(angle);
}

glm::dvec4 catmull_rom(const Track& track, const CatmullRomWeights& spline) {
  glm::dvec4 sum(0.0);
  glm::dvec4 previous(0.0);
  for (std::size_t i = 0; i < 4; ++i) {
    glm::dvec4 value(track.values[spline.key[i]]);
    if (track.channel.property == Property::Rotation && glm::dot(previous, value) < 0.0) value = -value;
    sum += spline.weight[i] * value;
    previous = value;
  }
  return track.channel.property == Property::Rotation ? glm::normalize(sum) : sum;
}

glm::dvec4 cubic(const Track& track, const KeySegment& segment, const HermiteWeights& weights) {
  glm::dvec4 sum = weights.from * glm::dvec4(track.values[segment.from]) + weights.to * glm::dvec4(track.values[segment.to]);
  if (!track.out_tangents.empty()) sum += weights.out_tangent * glm::dvec4(track.out_tangents[segment.from]);
  if (!track.in_tangents.empty()) sum += weights.in_tangent * glm::dvec4(track.in_tangents[segment.to]);
  return track.channel.property == Property::Rotation ? glm::normalize(sum) : sum;
}

glm::vec4 value_at(const Track& track, const KeyTimeline& timeline, double time_s, Interpolation fallback) {
  const KeySegment segment = locate(timeline, time_s);
  const KeyMode& key_mode = track.mode(segment.from);
  const Interpolation mode = key_mode.interpolation.value_or(fallback);
  const glm::vec4& from = track.values[segment.from];
  if (segment.from == segment.to || mode == Interpolation::Step) return from;
  if (mode == Interpolation::Cubic) {
    return glm::vec4(cubic(track, segment, hermite_weights(segment.u, segment_length_s(timeline, segment))));
  }
  const double u = key_mode.easing ? ease(*key_mode.easing, segment.u) : segment.u;
  if (mode == Interpolation::CatmullRom) return glm::vec4(catmull_rom(track, catmull_rom_weights(timeline, segment, u)));
  const glm::dvec4 a(from), b(track.values[segment.to]);
  return glm::vec4(track.channel.property == Property::Rotation ? slerp(a, b, u) : glm::mix(a, b, u));
}

void write(const Channel& channel, const glm::vec4& value, Pose& pose) {
  if (channel.property == Property::Weight) {
    pose.weights()[channel.target] = value.x;
    return;
  }
  const std::size_t first_row = static_cast<std::size_t>(channel.property == Property::Translation ? PoseRow::Tx
                                                         : channel.property == Property::Rotation  ? PoseRow::Rx
                                                                                                   : PoseRow::Sx);
  const int rows = channel.property == Property::Rotation ? 4 : 3;
  for (int i = 0; i < rows; ++i) {
    pose.row(static_cast<PoseRow>(first_row + static_cast<std::size_t>(i)))[channel.target] = value[i];
  }
}

}  // namespace

struct TrackSet::Packed {
  std::vector<Track> tracks;
  double duration_s = 0.0;
  bool closed = false;
};

TrackSet::TrackSet(std::span<const TrackSource> sources, double duration_s, bool closed)
    : packed_(std::make_unique<const Packed>(Packed{{sources.begin(), sources.end()}, duration_s, closed})) {}

TrackSet::~TrackSet() = default;
TrackSet::TrackSet(TrackSet&&) noexcept = default;
TrackSet& TrackSet::operator=(TrackSet&&) noexcept = default;

void TrackSet::sample(double time_s, Interpolation fallback, Pose& pose) const noexcept {
  for (const Track& track : packed_->tracks) {
    const KeyTimeline timeline{track.times_s, packed_->duration_s, packed_->closed};
    write(track.channel, value_at(track, timeline, time_s, fallback), pose);
  }
}

}  // namespace tweend::animation
