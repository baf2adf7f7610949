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
  Change operator()(const SetSceneSettings& c) const { return SetSceneSettings{std::exchange(scene.settings, c.value)}; }
};

}  // namespace

Change apply(Scene& scene, const Change& change) { return std::visit(Applier{scene}, change); }

}  // namespace tweend::stage
