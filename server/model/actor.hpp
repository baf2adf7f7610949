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
#include "server/model/clip.hpp"
#include "server/model/mesh.hpp"

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
  double spin_rad_s = 0.0;  ///< about +Y, while playing
  bool operator==(const ActorSettings&) const = default;
};

/// One model in a scene. A value: held as shared_ptr<const Actor>.
struct Actor {
  std::string name;
  std::string source;  ///< the asset's name, or "mesh" for one that came by command
  MeshPtr mesh;
  VertexKeyPtr rest;  ///< shown by a clip without keyframes
  ActorSettings settings;
  std::vector<ClipPtr> clips;  ///< at least one

  [[nodiscard]] ClipPtr find_clip(std::string_view clip) const noexcept;
};

using ActorPtr = std::shared_ptr<const Actor>;

/// The mode towards the next keyframe: the keyframe's, else the actor's, else the clip's, else linear.
[[nodiscard]] animation::Interpolation effective_interpolation(const Actor& actor, const Clip& clip, std::size_t key) noexcept;

/// Which keyframes of `clip` make what it shows at `time_s` (clamped to the clip). Precondition: there is a keyframe.
[[nodiscard]] animation::KeyBlend blend_at(const Actor& actor, const Clip& clip, double time_s) noexcept;

/// Evaluates the actor's vertices at `time_s` of `clip`, in model space; a clip without keyframes shows the rest shape.
/// Pure; allocates nothing; safe from any thread.
/// @return Internal where a length of `out` is neither 0 nor 3 × the mesh's vertices
[[nodiscard]] Status sample_vertices(const Actor& actor, const Clip& clip, double time_s,
                                     const animation::VertexTarget& out) noexcept;

}  // namespace tweend::model
