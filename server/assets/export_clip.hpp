#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "server/animation/track.hpp"
#include "server/assets/export_targets.hpp"
#include "server/assets/export_track.hpp"
#include "server/base/result.hpp"
#include "server/model/actor.hpp"

namespace tweend::assets {

/// A joint's property, as an animation moves it.
struct JointSamples {
  std::size_t joint = 0;
  animation::Property property = animation::Property::Translation;
  GlbSamples samples;
};

/// A clip by glTF's rules.
struct ClipSamples {
  std::vector<JointSamples> joints;
  std::optional<GlbSamples> weights;  ///< of all targets of the mesh; empty: none is moved
};

/// All that a clip keys, each channel with its keys and the mode that is in force for them: the keyframe's, the imported
/// track's, the actor's, the clip's, else linear. Of a clip of vertices the weights of its keyframes' targets. The last keys
/// are held until the clip's end. Pure.
/// @param targets      null for an actor without a mesh
/// @param most_values  numbers, all together
/// @return Limit for more. A clip without keyframes moves nothing
[[nodiscard]] Result<ClipSamples> clip_samples(const model::Actor& actor, const model::Clip& clip, const ExportTargets* targets,
                                               std::size_t most_values);

}  // namespace tweend::assets
