#include "server/assets/gltf_tracks.hpp"

#include <algorithm>
#include <memory>
#include <tuple>
#include <utility>

namespace tweend::assets {
namespace {

struct Event {
  double time_s = 0.0;
  GltfTimeline::Key key;
};

std::vector<Event> sorted_events(const std::vector<std::vector<float>>& lists) {
  std::vector<Event> events;
  for (std::uint32_t list = 0; list < lists.size(); ++list) {
    for (std::uint32_t key = 0; key < lists[list].size(); ++key) events.push_back({lists[list][key], {list, key}});
  }
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return std::tie(a.time_s, a.key.list, a.key.key) < std::tie(b.time_s, b.key.list, b.key.key);
  });
  return events;
}

model::ChannelModesPtr modes_of(const std::vector<GltfTrack>& tracks) {
  auto modes = std::make_shared<std::vector<model::ChannelMode>>();
  for (const GltfTrack& track : tracks) modes->push_back({track.channel, track.interpolation});
  std::sort(modes->begin(), modes->end(),
            [](const model::ChannelMode& a, const model::ChannelMode& b) { return a.channel < b.channel; });
  return modes;
}

}  // namespace

GltfTimeline merge_times(const std::vector<std::vector<float>>& lists) {
  constexpr std::size_t kNever = SIZE_MAX;
  GltfTimeline line;
  std::vector<std::size_t> last(lists.size(), kNever);  // the time at which a list had its last key
  for (const Event& event : sorted_events(lists)) {
    const bool first = line.times_s.empty();
    const double next_s = first ? 0.0 : line.times_s.back() + model::kSameTimeSeconds;
    const bool joins = !first && event.time_s < next_s && last[event.key.list] != line.times_s.size() - 1;
    if (!joins) {
      line.times_s.push_back(std::max(event.time_s, next_s));
      line.keys.emplace_back();
    }
    line.keys.back().push_back(event.key);
    last[event.key.list] = line.times_s.size() - 1;
  }
  return line;
}

model::Clip make_clip(std::string name, const std::vector<GltfTrack>& tracks, const std::vector<std::vector<float>>& lists) {
  std::vector<std::vector<std::size_t>> tracks_of(lists.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) tracks_of[tracks[i].times].push_back(i);
  GltfTimeline line = merge_times(lists);
  model::Clip clip;
  clip.name = std::move(name);
  clip.declared_type = model::ClipType::Skeletal;
  clip.channel_modes = modes_of(tracks);
  for (std::size_t t = 0; t < line.times_s.size(); ++t) {
    std::vector<model::KeyedValue> values;
    std::vector<model::KeyedTangents> tangents;
    bool any_tangents = false;
    for (const GltfTimeline::Key& key : line.keys[t]) {
      for (const std::size_t i : tracks_of[key.list]) {
        const GltfTrack& track = tracks[i];
        values.push_back({track.channel, track.values[key.key]});
        tangents.push_back(track.tangents.empty() ? model::KeyedTangents{} : track.tangents[key.key]);
        any_tangents |= !track.tangents.empty();
      }
    }
    if (!any_tangents) tangents.clear();
    clip.keyframes.push_back(
        {0, {}, {}, nullptr, std::make_shared<const model::PoseKey>(std::move(values), std::move(tangents))});
  }
  clip.times_s = std::move(line.times_s);
  return clip;
}

}  // namespace tweend::assets
