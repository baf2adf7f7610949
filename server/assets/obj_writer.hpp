#pragma once

#include <string_view>
#include <vector>

#include "server/assets/new_file.hpp"
#include "server/base/limits.hpp"
#include "server/base/result.hpp"
#include "server/model/actor.hpp"

namespace tweend::assets {

/// A keyframe's number in a sequence: its time in frames, 24 a second, rounded.
inline constexpr double kObjFramesPerSecond = 24.0;

/// A clip as an OBJ sequence: what the actor shows at each of its keyframes, in model space, after morphing and skinning, each
/// as `PREFIX_000000.obj`; a clip without keyframes as one file of what is shown then. Beside them `PREFIX.mtl` and a PNG for
/// each texture, where the mesh has materials. Every vertex has its own `v`, `vt` and `vn`, so that one reads back what was
/// written. Vertex colours are left out: OBJ has none.
///
/// Pure; safe from any thread; takes as long as a worker has.
/// @param prefix  of letters, digits, '_', '.' and '-'
/// @return InvalidParams, path "params.actor", for a skeleton alone, and for two keyframes that are the same frame; Limit for
///         more than Limits::asset_bytes together, which could not be read back; Unavailable if memory runs out
[[nodiscard]] Result<std::vector<NewFile>> write_obj_sequence(const model::Actor& actor, const model::ClipPtr& clip,
                                                              std::string_view prefix, const Limits& limits);

}  // namespace tweend::assets
