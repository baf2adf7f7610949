#include "server/model/clip.hpp"

#include <algorithm>
#include <map>

namespace tweend::model {
namespace {

/// The keys of one channel, gathered from the keyframes.
struct Track {
  std::vector<double> times_s;
  std::vector<glm::vec4> values;
  std::vector<glm::vec4> in_tangents;
  std::vector<glm::vec4> out_tangents;
  std::vector<animation::KeyMode> modes;
};

std::map<animation::Channel, Track> gather(const Clip& clip) {
  std::map<animation::Channel, Track> tracks;
  for (std::size_t k = 0; k < clip.keyframes.size(); ++k) {
    const Keyframe& keyframe = clip.keyframes[k];
    const std::span<const KeyedValue> values = keyframe.pose->values();
    const std::span<const KeyedTangents> tangents = keyframe.pose->tangents();
    for (std::size_t i = 0; i < values.size(); ++i) {
      Track& track = tracks[values[i].channel];
      track.times_s.push_back(clip.times_s[k]);
      track.values.push_back(values[i].value);
      const KeyedTangents none;
      track.in_tangents.push_back((tangents.empty() ? none : tangents[i]).in);
      track.out_tangents.push_back((tangents.empty() ? none : tangents[i]).out);
      const auto of_channel = clip.mode_of(values[i].channel);
      track.modes.push_back({keyframe.interpolation ? keyframe.interpolation : of_channel, keyframe.easing});
    }
  }
  return tracks;
}

animation::TrackSet pack(const Clip& clip, const Skeleton& skeleton) {
  const std::map<animation::Channel, Track> tracks = gather(clip);
  std::vector<animation::TrackSource> sources;
  for (const auto& [channel, track] : tracks) {
    animation::Channel at = channel;
    if (at.property != animation::Property::Weight) at.target = skeleton.place_of(at.target);
    sources.push_back({at, track.times_s, track.values, track.in_tangents, track.out_tangents, track.modes});
  }
  return {sources, clip.duration_s(), clip.settings.closed};
}

}  // namespace

ClipType Clip::type() const noexcept {
  if (keyframes.empty()) return declared_type;
  return keyframes.front().vertices ? ClipType::Vertex : ClipType::Skeletal;
}

std::optional<animation::Interpolation> Clip::mode_of(const animation::Channel& channel) const noexcept {
  if (!channel_modes) return std::nullopt;
  const auto at = std::lower_bound(channel_modes->begin(), channel_modes->end(), channel,
                                   [](const ChannelMode& m, const animation::Channel& c) { return m.channel < c; });
  if (at == channel_modes->end() || at->channel != channel) return std::nullopt;
  return at->interpolation;
}

const animation::TrackSet& Clip::tracks(const Skeleton& skeleton) const {
  return tracks_.get([&] { return pack(*this, skeleton); });
}

double Clip::duration_s() const noexcept {
  if (settings.duration_s) return *settings.duration_s;
  if (times_s.empty()) return 0.0;
  if (!settings.closed) return times_s.back();
  // A single keyframe has no spacing of its own: it gets that of keyframes added without a time.
  const double spacing =
      times_s.size() < 2 ? 1.0 : (times_s.back() - times_s.front()) / static_cast<double>(times_s.size() - 1);
  return times_s.back() + spacing;
}

std::optional<std::size_t> Clip::index_of(KeyframeId id) const noexcept {
  const auto at = std::find_if(keyframes.begin(), keyframes.end(), [id](const Keyframe& k) { return k.id == id; });
  if (at == keyframes.end()) return std::nullopt;
  return static_cast<std::size_t>(at - keyframes.begin());
}

std::size_t Clip::place_of(double time_s) const noexcept {
  return static_cast<std::size_t>(std::lower_bound(times_s.begin(), times_s.end(), time_s) - times_s.begin());
}

std::vector<Clip> empty_clips() {
  std::vector<Clip> clips(1);
  clips.front().name = "default";
  return clips;
}

}  // namespace tweend::model
