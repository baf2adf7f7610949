#include "server/app/render_offline.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <iostream>
#include <numbers>
#include <optional>
#include <utility>

#include "protocol/type_info.hpp"
#include "render/image_encoder.hpp"
#include "server/app/asset_path.hpp"
#include "server/app/contact_sheet.hpp"
#include "server/app/engine.hpp"
#include "server/app/loader.hpp"
#include "server/app/numbered_name.hpp"
#include "server/assets/asset_name.hpp"
#include "server/base/clock.hpp"
#include "server/base/progress_bar.hpp"
#include "server/streams/still.hpp"

namespace tweend::app {
namespace {

namespace fs = std::filesystem;

std::string json_string(std::string_view text) {
  std::string json;
  protocol::append_json_string(text, json);
  return json;
}

/// Where to look from, at all that is shown.
model::CameraRequest camera_of(const OfflineOptions& o) {
  model::CameraRequest camera;
  if (o.eye) {
    camera.eye = o.eye;
    camera.target = o.target;
    return camera;
  }
  constexpr float kRadians = std::numbers::pi_v<float> / 180.0F;
  const float azimuth = o.orbit_deg[0] * kRadians;
  const float elevation = o.orbit_deg[1] * kRadians;
  camera.orbit = {azimuth, elevation, {}, {}};
  // The upright picture's own up rather than the world's: from right above there is one, too.
  camera.up =
      glm::vec3(-std::sin(azimuth) * std::sin(elevation), std::cos(elevation), -std::cos(azimuth) * std::sin(elevation));
  camera.fit = true;
  return camera;
}

enum class FileKind { Png, Jpeg };

Result<FileKind> kind_of(const std::string& name) {
  std::string extension = fs::path(name).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".png") return FileKind::Png;
  if (extension == ".jpg" || extension == ".jpeg") return FileKind::Jpeg;
  return fail(ErrorCode::InvalidParams,
              fmt::format("expected a name that ends with .png, .jpg or .jpeg after --output, found \"{}\"", name));
}

Status write_file(const std::string& name, const std::vector<std::byte>& bytes) {
  std::ofstream file(name, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (file) return {};
  return fail(ErrorCode::Unavailable, fmt::format("expected a file that can be written at {}, found: {}", name,
                                                  std::error_code(errno, std::generic_category()).message()));
}

/// How far it is, on a terminal.
class Report {
 public:
  explicit Report(std::size_t total) : total_(total) {
    winsize window{};
    if (::isatty(STDERR_FILENO) != 0)
      bar_.emplace(::ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0 ? window.ws_col : 80);
  }
  ~Report() {
    if (bar_) std::cerr << bar_->clear() << std::flush;
  }
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;

  void done(std::size_t count) {
    if (!bar_) return;
    const ClockUs now_us = steady_now_us();
    const double elapsed_s = static_cast<double>(now_us - start_us_) * 1e-6;
    std::cerr << bar_->draw({count, total_, elapsed_s, static_cast<double>(count) / std::max(elapsed_s, 1e-3), "fps"}, now_us)
              << std::flush;
  }

 private:
  const std::size_t total_;
  const ClockUs start_us_ = steady_now_us();
  std::optional<ProgressBar> bar_;
};

class Offline {
 public:
  Offline(const OfflineOptions& options, std::vector<assets::AssetRoot> roots)
      : o_(options), engine_(options.limits, std::move(roots), options.render, metrics_, [this](Task task) {
          aside_.post(std::move(task));
        }) {}
  ~Offline() {
    engine_.stop();
    aside_.stop();
  }
  Offline(const Offline&) = delete;
  Offline& operator=(const Offline&) = delete;

  Status start() {
    if (const auto& device = engine_.renderer().device(); !device) return device.error();
    return engine_.start();
  }

  Status set_scene(const std::vector<AssetPath>& sources) {
    for (std::size_t i = 0; i < sources.size(); ++i) TWEEND_TRY(add_actor(sources[i], i));
    std::string look;
    if (o_.background) look = fmt::format(R"(,"background":{})", json(*o_.background));
    TWEEND_TRY(run_edit(engine_.services(), "scene.update", fmt::format(R"({{"grid":{}{}}})", o_.grid, look)));
    if (!o_.light) return {};
    return run_edit(engine_.services(), "light.set", fmt::format(R"({{"position":{}}})", json(*o_.light)));
  }

  Status draw_all() {
    const render::Size each = o_.size;
    TWEEND_TRY(check_camera());
    std::optional<ContactSheet> sheet;
    if (o_.sheet) {
      TWEEND_TRY(ContactSheet::check(each, o_.times_s.size()));
      sheet.emplace(each, o_.times_s.size());
    }
    Report report(o_.times_s.size());
    for (std::size_t i = 0; i < o_.times_s.size(); ++i) {
      TWEEND_ASSIGN(const streams::DrawnStill drawn, draw(o_.times_s[i], each));
      if (sheet) {
        sheet->put(i, drawn.pixels->view());
      } else {
        TWEEND_ASSIGN(const std::string name, numbered_name(o_.output, i, o_.times_s.size() > 1));
        TWEEND_TRY(write(name, drawn.pixels->view()));
      }
      report.done(i + 1);
    }
    if (!sheet) return {};
    TWEEND_ASSIGN(const std::string name, numbered_name(o_.output, 0, false));
    return write(name, sheet->view());
  }

 private:
  [[nodiscard]] model::ScenePtr scene() const { return engine_.services().stage.view()->find("main")->scene; }
  static std::string json(const glm::vec3& v) { return fmt::format("[{},{},{}]", v.x, v.y, v.z); }

  /// A camera that could show nothing is drawn as the scene's, which a viewer may like and a file's author would not.
  [[nodiscard]] Status check_camera() const {
    const model::ScenePtr shown = scene();
    const float aspect = static_cast<float>(o_.size.width) / static_cast<float>(o_.size.height);
    TWEEND_TRY(model::place(shown->settings.camera, camera_of(o_), model::visible_bounds(*shown), aspect));
    return {};
  }

  /// Beside the ones before it.
  Status add_actor(const AssetPath& source, std::size_t index) {
    const std::string name = fmt::format("{}_{}", actor_name(source.name).substr(0, 50), index + 1);
    std::string json = fmt::format(R"({{"actor":{},"asset":{})", json_string(name), json_string(source.name));
    // A glTF file says when its frames are.
    if (!assets::is_gltf_name(source.name)) json += fmt::format(R"(,"fps":{},"closed":{})", o_.fps, o_.closed);
    if (!assets::is_gltf_name(source.name) && o_.duration_s > 0.0) json += fmt::format(R"(,"duration":{})", o_.duration_s);
    if (!o_.interpolation.empty()) {
      json +=
          fmt::format(R"(,"interpolation":{})", json_string(o_.interpolation[std::min(index, o_.interpolation.size() - 1)]));
    }
    TWEEND_TRY(run_edit(engine_.services(), "actor.add", json + "}"));
    if (!o_.clip.empty()) TWEEND_TRY(show_clip(engine_.services(), name, o_.clip));
    model::Scene alone;
    alone.actors = {scene()->find_actor(name)};
    const model::Bounds own = model::visible_bounds(alone).value_or(model::Bounds{});
    const float gap = 0.1F * (own.max.x - own.min.x);
    const float x = index == 0 ? 0.0F : right_edge_ + gap - own.min.x;
    right_edge_ = x + own.max.x;
    if (index == 0) return {};
    return run_edit(engine_.services(), "actor.update",
                    fmt::format(R"({{"actor":{},"transform":{{"translation":[{},0,0]}}}})", json_string(name), x));
  }

  Result<streams::DrawnStill> draw(double time_s, render::Size size) {
    const commands::Services& services = engine_.services();
    streams::StillRequest request;
    request.view = services.stage.view()->find("main");
    request.time_s = time_s;
    request.size = size;
    request.camera = camera_of(o_);
    std::promise<Result<streams::DrawnStill>> promise;
    streams::draw_still(std::move(request), services.workers, services.renderer,
                        [&promise](Result<streams::DrawnStill> drawn) { promise.set_value(std::move(drawn)); });
    return promise.get_future().get();
  }

  Status write(const std::string& name, const render::ImageView& image) {
    TWEEND_ASSIGN(const FileKind kind, kind_of(name));
    TWEEND_ASSIGN(const std::vector<std::byte> file,
                  kind == FileKind::Jpeg ? render::encode_jpeg(image, o_.quality) : render::encode_png(image));
    TWEEND_TRY(write_file(name, file));
    std::cout << fmt::format("{}: {} x {}, {:.1f} kB\n", name, image.size.width, image.size.height,
                             static_cast<double>(file.size()) / 1000.0);
    return {};
  }

  const OfflineOptions& o_;
  Metrics metrics_;
  WorkerPool aside_{1};  ///< where events would be handed over, were there anybody to hear them
  Engine engine_;
  float right_edge_ = 0.0F;
};

Status run(const OfflineOptions& options) {
  TWEEND_TRY(numbered_name(options.output, 0, !options.sheet && options.times_s.size() > 1));
  TWEEND_TRY(kind_of(options.output));
  if (options.interpolation.size() > options.assets.size()) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected at most one --interpolation for each of {} asset{}, found {}", options.assets.size(),
                            options.assets.size() == 1 ? "" : "s", options.interpolation.size()));
  }
  std::vector<AssetPath> sources;
  std::vector<std::string> folders;
  for (const std::string& path : options.assets) {
    TWEEND_ASSIGN(AssetPath source, locate_asset(path));
    for (const AssetPath& other : sources) {
      if (other.name == source.name && other.folder != source.folder) {
        return fail(ErrorCode::InvalidParams,
                    fmt::format("expected assets of different names, found {0}/{2} and {1}/{2}; rename one", other.folder,
                                source.folder, source.name));
      }
    }
    if (std::find(folders.begin(), folders.end(), source.folder) == folders.end()) folders.push_back(source.folder);
    sources.push_back(std::move(source));
  }
  TWEEND_ASSIGN(std::vector<assets::AssetRoot> roots, open_roots(folders));
  Offline offline(options, std::move(roots));
  TWEEND_TRY(offline.start());
  TWEEND_TRY(offline.set_scene(sources));
  return offline.draw_all();
}

}  // namespace

int render_offline(const OfflineOptions& options) {
  const Status status = run(options);
  if (status) return 0;
  std::cerr << "tweend: " << status.error().message << '\n';
  return 1;
}

}  // namespace tweend::app
