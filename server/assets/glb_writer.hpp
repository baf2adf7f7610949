#pragma once

#include <string>

#include "server/base/limits.hpp"
#include "server/base/result.hpp"
#include "server/model/actor.hpp"

namespace tweend::assets {

/// The actor as a .glb file: its skeleton at rest, its mesh with materials, skin and morph targets, and all its clips; read
/// back, they sample the same (docs/PROTOCOL.md, 5.3 has what that means). Not where it stands in its scene, its layers and its
/// look while playing. Clips without keyframes are left out.
///
/// Pure; time and memory are proportional to the file. Safe from any thread; takes as long as a worker has.
/// @return Limit for more than Limits::asset_bytes, which could not be read back; InvalidParams where a vertex clip can't be
///         told as morph targets (see RestPose); Unavailable if memory runs out
[[nodiscard]] Result<std::string> write_glb(const model::Actor& actor, const Limits& limits);

}  // namespace tweend::assets
