#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/app/asset_path.hpp"
#include "server/app/engine.hpp"
#include "server/app/render_offline.hpp"
#include "server/model/camera.hpp"

namespace tweend::app {

/// The scene that `tweend render` draws, on an engine without a network.
class OfflineScene {
 public:
  /// @param options  outlive it
  OfflineScene(const OfflineOptions& options, std::vector<assets::AssetRoot> roots);
  ~OfflineScene();
  OfflineScene(const OfflineScene&) = delete;
  OfflineScene& operator=(const OfflineScene&) = delete;

  /// @return Unavailable where nothing draws
  [[nodiscard]] Status start();
  /// Assets, side by side.
  [[nodiscard]] Status show(const std::vector<AssetPath>& sources);
  /// What a file of edits makes, as `tweenctl apply` takes it.
  [[nodiscard]] Status show_edits(const std::string& json);
  /// @return InvalidParams where the options' camera could show nothing
  [[nodiscard]] Status check_camera() const;

  [[nodiscard]] const commands::Services& services() const noexcept { return engine_.services(); }
  [[nodiscard]] stage::SceneViewPtr view() const { return services().stage.view()->find("main"); }
  /// Where to look from; empty: the scene's own camera.
  [[nodiscard]] std::optional<model::CameraRequest> camera() const;

 private:
  [[nodiscard]] Status set_look(bool grid_too);
  [[nodiscard]] Status add_actor(const AssetPath& source, std::size_t index);

  const OfflineOptions& o_;
  Metrics metrics_;
  WorkerPool aside_{1};  ///< where events would be handed over, were there anybody to hear them
  Engine engine_;
  float right_edge_ = 0.0F;
};

}  // namespace tweend::app
