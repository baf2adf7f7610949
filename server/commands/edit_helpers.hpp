#pragma once

#include <string>

#include "server/base/result.hpp"
#include "server/model/clip.hpp"

namespace tweend::commands {

/// Whether the clip's explicit duration, if it has one, lies beyond its last keyframe (an open clip's may lie on it).
/// @param path  of the parameter that would be to blame
[[nodiscard]] Status check_duration(const model::Clip& clip, const std::string& path = "params.duration");

/// Whether a keyframe may stand at `time_s`: not within 1 µs of another than `except`, nor beyond an explicit duration.
[[nodiscard]] Status check_keyframe_time(const model::Clip& clip, double time_s, model::KeyframeId except = 0);

}  // namespace tweend::commands
