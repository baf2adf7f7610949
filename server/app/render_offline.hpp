#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "render/render_thread.hpp"
#include "server/base/limits.hpp"

namespace tweend::app {

/// What `tweend render` was asked for.
struct OfflineOptions {
  std::vector<std::string> assets;         ///< paths of files or of sequences' folders; side by side along +X
  std::vector<std::string> interpolation;  ///< for each asset; the last one for all that follow; empty: as the clips say
  std::vector<double> times_s{0.0};
  std::string output = "frame-%04d.png";  ///< `%d`, `%04d`: the picture's number, from 0
  bool sheet = false;                     ///< all pictures in one, left to right, top to bottom
  render::Size size{1280, 720};
  std::string clip;   ///< which one to show, of every asset; empty: the first
  double fps = 24.0;  ///< of OBJ sequences, as are the next two
  bool closed = false;
  double duration_s = 0.0;                       ///< 0: as the keyframes say
  std::array<float, 2> orbit_deg{30.0F, 20.0F};  ///< azimuth from +Z towards +X, elevation; fitted to what is seen
  std::optional<glm::vec3> eye, target;          ///< in place of orbit
  std::optional<glm::vec3> background;           ///< sRGB; empty: as a scene's
  std::optional<glm::vec3> light;                ///< its place; empty: as a scene's
  bool grid = false;
  int quality = 90;
  render::RenderOptions render{.samples = 4};  ///< a picture that is kept is worth the wait
  Limits limits;
};

/// Draws assets to picture files, without a server. @return the process's exit code: 0 done, 1 refused, 2 misused
[[nodiscard]] int render_offline(const OfflineOptions& options);

}  // namespace tweend::app
