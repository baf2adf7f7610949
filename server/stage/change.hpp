#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>

#include "server/model/scene.hpp"

namespace tweend::stage {

// The primitive changes that every edit is made of. Each names what it touches and holds the whole new value there (empty:
// nothing), so that applying it yields a change of the same kind that takes it back: undo, redo and the journal need no other
// code. Values are shared pointers or small: no change ever copies a vertex.

/// Adds, replaces or removes an actor.
struct SetActor {
  std::string actor;
  model::ActorPtr value;
  std::size_t index = SIZE_MAX;  ///< its place in the scene when added; past the end: last
};

struct SetActorSettings {
  std::string actor;
  model::ActorSettings value;
};

/// Adds, replaces or removes a clip.
struct SetClip {
  std::string actor;
  std::string clip;
  model::ClipPtr value;
  std::size_t index = SIZE_MAX;
};

struct SetClipSettings {
  std::string actor;
  std::string clip;
  model::ClipSettings value;
};

struct TimedKeyframe {
  double time_s = 0.0;
  model::Keyframe keyframe;
};

/// Adds, replaces (also at another time) or removes a keyframe.
struct SetKeyframe {
  std::string actor;
  std::string clip;
  model::KeyframeId keyframe = 0;
  std::optional<TimedKeyframe> value;
};

/// Adds, replaces or removes a marker.
struct SetMarker {
  std::string actor;
  std::string clip;
  model::KeyframeId marker = 0;
  std::optional<model::Marker> value;
};

/// Adds, replaces or removes a layer.
struct SetLayer {
  std::string actor;
  std::string layer;
  std::optional<model::Layer> value;
};

struct SetSceneSettings {
  model::SceneSettings value;
};

using Change =
    std::variant<SetActor, SetActorSettings, SetClip, SetClipSettings, SetKeyframe, SetMarker, SetLayer, SetSceneSettings>;

/// Applies a change and returns the one that takes it back.
/// Precondition: the actor and clip it names are there (commands check that before). Does not touch the revision.
[[nodiscard]] Change apply(model::Scene& scene, const Change& change);

}  // namespace tweend::stage
