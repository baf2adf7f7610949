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
  std::vector<std::string> assets;  ///< paths of files or of sequences' folders; side by side along +X. Or one file of edits
  std::string assets_folder;        ///< whose assets a file of edits names; empty: its own folder
  std::vector<std::string> interpolation;  ///< for each asset; the last one for all that follow; empty: as the clips say
  std::vector<double> times_s{0.0};
  std::string output = "frame-%04d.png";  ///< `%d`, `%04d`: the picture's number, from 0
  bool sheet = false;                     ///< all pictures in one, left to right, top to bottom
  std::string mp4;                        ///< a film in place of pictures: the file it goes to
  double film_fps = 30.0;
  std::optional<double> from_s, to_s;  ///< of the film; empty: the clip's ends
  render::Size size{1280, 720};
  std::string clip;   ///< which one to show, of every asset; empty: the first
  double fps = 24.0;  ///< of OBJ sequences, as are the next two
  bool closed = false;
  double duration_s = 0.0;                       ///< 0: as the keyframes say
  std::array<float, 2> orbit_deg{30.0F, 20.0F};  ///< azimuth from +Z towards +X, elevation; fitted to what is seen
  std::optional<glm::vec3> eye, target;          ///< in place of orbit
  bool looks_from = false;                       ///< orbit or eye was asked for: a file of edits has its own camera
  std::optional<glm::vec3> background;           ///< sRGB; empty: as a scene's
  std::optional<glm::vec3> light;                ///< its place; empty: as a scene's
  bool grid = false;
  int quality = 90;
  render::RenderOptions render{.samples = 4};  ///< a picture that is kept is worth the wait
  Limits limits;

  /// Whether it is a file of edits that is to be drawn.
  [[nodiscard]] bool is_scene() const noexcept { return assets.size() == 1 && assets.front().ends_with(".json"); }
};

/// Draws assets to picture files or a film, without a server. @return the process's exit code: 0 done, 1 refused, 2 misused
[[nodiscard]] int render_offline(const OfflineOptions& options);

}  // namespace tweend::app
