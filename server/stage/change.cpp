#include "server/stage/change.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <tuple>
#include <utility>

namespace tweend::stage {
namespace {

using model::Actor;
using model::ActorPtr;
using model::Clip;
using model::ClipPtr;
using model::Scene;

/// Replaces, inserts (at `index`, else last) or erases one element of a list of named pointers; what stood there before.
template <class Pointer>
std::pair<Pointer, std::size_t> put(std::vector<Pointer>& list, const std::string& name, const Pointer& value,
                                    std::size_t index) {
  const auto at = std::find_if(list.begin(), list.end(), [&](const Pointer& p) { return p->name == name; });
  if (at == list.end()) {
    if (value) list.insert(list.begin() + static_cast<std::ptrdiff_t>(std::min(index, list.size())), value);
    return {nullptr, index};
  }
  const auto place = static_cast<std::size_t>(at - list.begin());
  Pointer before = *at;
  if (value) {
    *at = value;
  } else {
    list.erase(at);
  }
  return {std::move(before), place};
}

template <class Edit>
void update_actor(Scene& scene, const std::string& name, Edit&& edit) {
  for (ActorPtr& actor : scene.actors) {
    if (actor->name != name) continue;
    auto copy = std::make_shared<Actor>(*actor);
    edit(*copy);
    actor = std::move(copy);
    return;
  }
}

template <class Edit>
void update_clip(Scene& scene, const std::string& actor, const std::string& clip, Edit&& edit) {
  update_actor(scene, actor, [&](Actor& a) {
    for (ClipPtr& c : a.clips) {
      if (c->name != clip) continue;
      auto copy = std::make_shared<Clip>(*c);
      edit(*copy);
      c = std::move(copy);
      return;
    }
  });
}

// Takes the keyframe out, if it is there, and puts the new one in its place in time.
std::optional<TimedKeyframe> put_keyframe(Clip& clip, model::KeyframeId id, const std::optional<TimedKeyframe>& value) {
  std::optional<TimedKeyframe> before;
  if (const auto index = clip.index_of(id)) {
    const auto at = static_cast<std::ptrdiff_t>(*index);
    before = TimedKeyframe{clip.times_s[*index], clip.keyframes[*index]};
    clip.times_s.erase(clip.times_s.begin() + at);
    clip.keyframes.erase(clip.keyframes.begin() + at);
  }
  if (value) {
    const auto at = static_cast<std::ptrdiff_t>(clip.place_of(value->time_s));
    clip.times_s.insert(clip.times_s.begin() + at, value->time_s);
    clip.keyframes.insert(clip.keyframes.begin() + at, value->keyframe);
  }
  return before;
}

// Takes the marker out, if it is there, and puts the new one in its place in time.
std::optional<model::Marker> put_marker(Clip& clip, model::KeyframeId id, const std::optional<model::Marker>& value) {
  std::optional<model::Marker> before;
  std::vector<model::Marker> markers = clip.markers ? *clip.markers : std::vector<model::Marker>();
  const auto at = std::find_if(markers.begin(), markers.end(), [id](const model::Marker& m) { return m.id == id; });
  if (at != markers.end()) {
    before = std::move(*at);
    markers.erase(at);
  }
  if (value) {
    const auto earlier = [](const model::Marker& a, const model::Marker& b) {
      return a.time_s != b.time_s ? a.time_s < b.time_s : a.id < b.id;
    };
    markers.insert(std::lower_bound(markers.begin(), markers.end(), *value, earlier), *value);
  }
  clip.markers = markers.empty() ? nullptr : std::make_shared<const std::vector<model::Marker>>(std::move(markers));
  return before;
}

std::optional<model::Layer> put_layer(Actor& actor, const std::string& name, const std::optional<model::Layer>& value) {
  std::optional<model::Layer> before;
  const auto below = [](const model::Layer& l, const std::string& n) { return l.name < n; };
  auto at = std::lower_bound(actor.layers.begin(), actor.layers.end(), name, below);
  if (at != actor.layers.end() && at->name == name) {
    before = std::move(*at);
    at = actor.layers.erase(at);
  }
  if (value) actor.layers.insert(at, *value);
  return before;
}

struct Applier {
  Scene& scene;

  Change operator()(const SetActor& c) const {
    auto [before, index] = put(scene.actors, c.actor, c.value, c.index);
    return SetActor{c.actor, std::move(before), index};
  }
  Change operator()(const SetActorSettings& c) const {
    SetActorSettings inverse{c.actor, {}};
    update_actor(scene, c.actor, [&](Actor& a) { inverse.value = std::exchange(a.settings, c.value); });
    return inverse;
  }
  Change operator()(const SetClip& c) const {
    SetClip inverse{c.actor, c.clip, nullptr, c.index};
    update_actor(scene, c.actor,
                 [&](Actor& a) { std::tie(inverse.value, inverse.index) = put(a.clips, c.clip, c.value, c.index); });
    return inverse;
  }
  Change operator()(const SetClipSettings& c) const {
    SetClipSettings inverse{c.actor, c.clip, {}};
    update_clip(scene, c.actor, c.clip, [&](Clip& clip) { inverse.value = std::exchange(clip.settings, c.value); });
    return inverse;
  }
  Change operator()(const SetKeyframe& c) const {
    SetKeyframe inverse{c.actor, c.clip, c.keyframe, {}};
    update_clip(scene, c.actor, c.clip, [&](Clip& clip) { inverse.value = put_keyframe(clip, c.keyframe, c.value); });
    return inverse;
  }
  Change operator()(const SetMarker& c) const {
    SetMarker inverse{c.actor, c.clip, c.marker, {}};
    update_clip(scene, c.actor, c.clip, [&](Clip& clip) { inverse.value = put_marker(clip, c.marker, c.value); });
    return inverse;
  }
  Change operator()(const SetLayer& c) const {
    SetLayer inverse{c.actor, c.layer, {}};
    update_actor(scene, c.actor, [&](Actor& a) { inverse.value = put_layer(a, c.layer, c.value); });
    return inverse;
  }
  Change operator()(const SetSceneSettings& c) const { return SetSceneSettings{std::exchange(scene.settings, c.value)}; }
};

}  // namespace

Change apply(Scene& scene, const Change& change) { return std::visit(Applier{scene}, change); }

}  // namespace tweend::stage
