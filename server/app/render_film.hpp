#pragma once

#include "server/app/offline_scene.hpp"

namespace tweend::app {

/// What can be said of a film before anything is read.
/// @return InvalidParams for a name that does not end with .mp4, sides that are odd or too long, a rate out of range, or times
/// the wrong way round; Limit for too many pictures; Unavailable in a build without H.264
[[nodiscard]] Status check_film(const OfflineOptions& options);

/// Draws each actor's clip from the first time to before the last one, by default all of the first actor's: exactly
/// round((to - from) × fps) pictures, at least one. The next picture is drawn while one is encoded.
/// @return Unavailable where the file can't be written; nothing of it is left then
[[nodiscard]] Status render_film(const OfflineOptions& options, const OfflineScene& scene);

}  // namespace tweend::app
