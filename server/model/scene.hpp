#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/model/actor.hpp"
#include "server/model/camera.hpp"

namespace tweend::model {

/// One point light, shaded per pixel (Blinn-Phong). The defaults are the values of the technique's first publication.
struct Light {
  glm::vec3 position{0.0F, 3.0F, 5.0F};  ///< world space, metres
  float ambient = 0.2F;                  ///< intensities, >= 0
  float diffuse = 1.0F;
  float specular = 0.5F;
  float shininess = 128.0F;  ///< exponent, > 0
  bool operator==(const Light&) const = default;
};

/// What can be said of a scene beside its actors.
struct SceneSettings {
  Camera camera;
  Light light;
  glm::vec3 background{0.07F, 0.08F, 0.1F};  ///< sRGB, 0 to 1
  bool grid = false;
  bool operator==(const SceneSettings&) const = default;
};

/// A whole scene at one revision: an immutable value, shared by whoever shows it. A copy copies pointers.
struct Scene {
  std::string name;
  std::uint64_t revision = 0;    ///< each accepted edit raises it by one
  KeyframeId next_keyframe = 1;  ///< only grows, also through undo: ids are never reused
  SceneSettings settings;
  std::vector<ActorPtr> actors;  ///< in the order they were added

  [[nodiscard]] ActorPtr find_actor(std::string_view actor) const noexcept;
};

using ScenePtr = std::shared_ptr<const Scene>;

/// A world-space box around everything that the visible actors show in all their clips, spin and overshoot included;
/// empty where nothing is visible.
[[nodiscard]] std::optional<Bounds> visible_bounds(const Scene& scene);

}  // namespace tweend::model
