#pragma once

#include "server/model/actor.hpp"
#include "server/model/bounds.hpp"

namespace tweend::model {

/// A box around everything that a clip of the actor shows, overshoot included, in model space. Of vertex keyframes it follows
/// from their boxes and weights; of a pose from the boxes of what each joint moves, looked at some 30 times a second, and so it
/// may be passed by a little between two looks. Includes the joints where there is nothing else to see.
[[nodiscard]] Bounds clip_bounds(const Actor& actor, const ClipPtr& clip);

/// Around all clips of the actor.
[[nodiscard]] Bounds model_bounds(const Actor& actor);

}  // namespace tweend::model
