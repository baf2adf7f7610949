#include "server/app/offline_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "protocol/type_info.hpp"
#include "server/app/loader.hpp"
#include "server/assets/asset_name.hpp"

namespace tweend::app {
namespace {

std::string json_string(std::string_view text) {
  std::string json;
  protocol::append_json_string(text, json);
  return json;
}

std::string vector_json(const glm::vec3& v) { return fmt::format("[{},{},{}]", v.x, v.y, v.z); }

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

}  // namespace

OfflineScene::OfflineScene(const OfflineOptions& options, std::vector<assets::AssetRoot> roots)
    : o_(options),
      engine_(options.limits, std::move(roots), options.render, metrics_, [this](Task task) { aside_.post(std::move(task)); }) {
}

OfflineScene::~OfflineScene() {
  engine_.stop();
  aside_.stop();
}

Status OfflineScene::start() {
  if (const auto& device = engine_.renderer().device(); !device) return device.error();
  return engine_.start();
}

Status OfflineScene::show(const std::vector<AssetPath>& sources) {
  for (std::size_t i = 0; i < sources.size(); ++i) TWEEND_TRY(add_actor(sources[i], i));
  return set_look(true);
}

Status OfflineScene::show_edits(const std::string& json) {
  TWEEND_TRY(run_edit(services(), "edit.apply", fmt::format(R"({{"edits":{}}})", json)));
  const model::ScenePtr scene = view()->scene;
  if (!o_.clip.empty()) {
    if (scene->actors.empty()) return fail(ErrorCode::NotFound, "expected an actor for --clip, found none");
    TWEEND_TRY(show_clip(services(), scene->actors.front()->name, o_.clip));
  }
  return set_look(o_.grid);
}

Status OfflineScene::set_look(bool grid_too) {
  std::string look;
  if (grid_too) look = fmt::format(R"("grid":{})", o_.grid);
  if (o_.background) look += fmt::format(R"({}"background":{})", look.empty() ? "" : ",", vector_json(*o_.background));
  if (!look.empty()) TWEEND_TRY(run_edit(services(), "scene.update", fmt::format("{{{}}}", look)));
  if (!o_.light) return {};
  return run_edit(services(), "light.set", fmt::format(R"({{"position":{}}})", vector_json(*o_.light)));
}

std::optional<model::CameraRequest> OfflineScene::camera() const {
  if (o_.is_scene() && !o_.looks_from) return std::nullopt;
  return camera_of(o_);
}

// A camera that could show nothing is drawn as the scene's, which a viewer may like and a file's author would not.
Status OfflineScene::check_camera() const {
  const auto own = camera();
  if (!own) return {};
  const model::ScenePtr shown = view()->scene;
  const float aspect = static_cast<float>(o_.size.width) / static_cast<float>(o_.size.height);
  TWEEND_TRY(model::place(shown->settings.camera, *own, model::visible_bounds(*shown), aspect));
  return {};
}

Status OfflineScene::add_actor(const AssetPath& source, std::size_t index) {
  const std::string name = fmt::format("{}_{}", actor_name(source.name).substr(0, 50), index + 1);
  std::string json = fmt::format(R"({{"actor":{},"asset":{})", json_string(name), json_string(source.name));
  // A glTF file says when its frames are.
  if (!assets::is_gltf_name(source.name)) json += fmt::format(R"(,"fps":{},"closed":{})", o_.fps, o_.closed);
  if (!assets::is_gltf_name(source.name) && o_.duration_s > 0.0) json += fmt::format(R"(,"duration":{})", o_.duration_s);
  if (!o_.interpolation.empty()) {
    json += fmt::format(R"(,"interpolation":{})", json_string(o_.interpolation[std::min(index, o_.interpolation.size() - 1)]));
  }
  TWEEND_TRY(run_edit(engine_.services(), "actor.add", json + "}"));
  if (!o_.clip.empty()) TWEEND_TRY(show_clip(engine_.services(), name, o_.clip));
  model::Scene alone;
  alone.actors = {view()->scene->find_actor(name)};
  const model::Bounds own = model::visible_bounds(alone).value_or(model::Bounds{});
  const float gap = 0.1F * (own.max.x - own.min.x);
  const float x = index == 0 ? 0.0F : right_edge_ + gap - own.min.x;
  right_edge_ = x + own.max.x;
  if (index == 0) return {};
  return run_edit(engine_.services(), "actor.update",
                  fmt::format(R"({{"actor":{},"transform":{{"translation":[{},0,0]}}}})", json_string(name), x));
}

}  // namespace tweend::app
