#pragma once

#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/animation/key_blend.hpp"
#include "server/animation/vertex_attributes.hpp"
#include "server/model/model.hpp"

namespace tweend::model {

/// Where an actor stands in its scene: scaled, then rotated, then moved.
struct Transform {
  glm::vec3 translation{0.0F};                 ///< metres
  glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};  ///< unit; constructor w,x,y,z, wire x,y,z,w
  glm::vec3 scale{1.0F};
  bool operator==(const Transform&) const = default;
};

/// @param spin_angle_rad  a turn about the actor's own +Y, before its rotation
[[nodiscard]] glm::mat4 world_from_model(const Transform& transform, double spin_angle_rad) noexcept;

/// What can be said of an actor beside its model and clips.
struct ActorSettings {
  Transform transform;
  std::optional<animation::Interpolation> interpolation;  ///< beats the clips', is beaten by a keyframe's
  bool visible = true;
  bool show_skeleton = false;  ///< draws the bones over the mesh
  double spin_rad_s = 0.0;     ///< about +Y, while playing
  bool operator==(const ActorSettings&) const = default;
};

/// A clip that is blended over the player's.
struct Layer {
  std::string name;
  std::string clip;
  float weight = 1.0F;                                       ///< 0 to 1
  bool additive = false;                                     ///< adds what differs from the rest pose, rather than replace
  std::shared_ptr<const std::vector<std::uint32_t>> joints;  ///< whose pose it touches, ascending; null: all
  /// The same as a factor for each joint in the order of evaluation, made once; null: all.
  std::shared_ptr<const std::vector<float>> mask;
  bool operator==(const Layer&) const = default;
};

/// One model in a scene. A value: held as shared_ptr<const Actor>.
struct Actor {
  std::string name;
  std::string source;  ///< the asset's name, or "mesh" or "skeleton" for one that came by command
  ModelPtr model;
  ActorSettings settings;
  std::vector<ClipPtr> clips;  ///< at least one
  std::vector<Layer> layers;   ///< in the order of their names

  [[nodiscard]] ClipPtr find_clip(std::string_view clip) const noexcept;
};

using ActorPtr = std::shared_ptr<const Actor>;

/// The mode towards the next keyframe: the keyframe's, else that of the (first) track it keys, else the actor's, else the
/// clip's, else linear.
[[nodiscard]] animation::Interpolation effective_interpolation(const Actor& actor, const Clip& clip, std::size_t key) noexcept;

/// Which keyframes of `clip` make what it shows at `time_s` (clamped to the clip). Precondition: there is a keyframe.
[[nodiscard]] animation::KeyBlend blend_at(const Actor& actor, const Clip& clip, double time_s) noexcept;

/// The vertices that the keyframes of a vertex clip make at `time_s`, in model space.
/// Pure; allocates nothing; safe from any thread. Precondition: there is a keyframe.
/// @return Internal where a length of `out` is neither 0 nor 3 × the mesh's vertices
[[nodiscard]] Status sample_keyframes(const Actor& actor, const Clip& clip, double time_s,
                                      const animation::VertexTarget& out) noexcept;

}  // namespace tweend::model
