#pragma once

#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <memory>
#include <vector>

#include "server/model/clip.hpp"

namespace tweend::model {

/// A moment of a clip, and how far it has replaced what stands before it.
struct ClipInstant {
  ClipPtr clip;
  double time_s = 0.0;  ///< clamped to the clip
  float weight = 1.0F;  ///< 0 to 1; of the first it is not looked at
};

/// A factor for each joint in the order of evaluation, 0 to 1.
using JointMask = std::shared_ptr<const std::vector<float>>;

/// A moment of a layer over the clips.
struct LayerInstant {
  ClipPtr clip;  ///< skeletal
  double time_s = 0.0;
  float weight = 1.0F;  ///< 0 to 1
  bool additive = false;
  JointMask mask;  ///< null: every joint, and the morph weights
};

/// More cross-fades than these at once, and the oldest is cut short.
inline constexpr std::size_t kMostFades = 8;
/// Layers of an actor, those that fade out included.
inline constexpr std::size_t kMostLayers = 32;

/// Everything that makes what one actor shows: clips that fade into each other, layers over them, a live pose over those.
/// A value without a clock: evaluating it is a pure function.
struct Shown {
  boost::container::static_vector<ClipInstant, kMostFades + 1> clips;  ///< at least one; the last is the player's own
  boost::container::static_vector<LayerInstant, kMostLayers> layers;   ///< in the order they are applied
  PoseKeyPtr live;                                                     ///< null: none
};

/// One clip at one time and nothing else.
[[nodiscard]] Shown shown_clip(ClipPtr clip, double time_s);

}  // namespace tweend::model
