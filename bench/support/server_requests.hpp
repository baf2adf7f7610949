#pragma once

#include <string>

#include "bench/support/server_process.hpp"
#include "bench/support/sphere_scene.hpp"

// What benchmarks ask of a server beside what they measure. What fails ends the program.

namespace tweend::bench {

/// A line of line JSON with the id 7.
/// @param params  an object, as JSON
[[nodiscard]] std::string request(const std::string& method, const std::string& params);

/// Asks and expects a result.
void must(LineClient& client, const std::string& method, const std::string& params);

/// A figure of `server.stats`.
/// @param name  without the "tweend_" before it
[[nodiscard]] double stat(LineClient& client, const std::string& name);

/// An actor `sphere` on a closed clip of two seconds, paused at 0: from the sphere (0 s) to its lobes (1 s) and back.
/// @param lobes  as in SphereGrid::positions
void add_sphere(LineClient& client, const SphereGrid& sphere, float lobes);

}  // namespace tweend::bench
