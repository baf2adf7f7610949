#pragma once

#include <span>
#include <vector>

#include "server/animation/affine.hpp"
#include "server/animation/pose.hpp"
#include "server/animation/vertex_attributes.hpp"
#include "server/base/result.hpp"
#include "server/model/actor.hpp"
#include "server/model/shown.hpp"

namespace tweend::model {

/// Evaluates what an actor shows. Keeps its memory from one time to the next: used again for the same actor it allocates
/// nothing. One thread at a time; what it returns lasts until it is used again.
class Evaluator {
 public:
  /// Every joint's local transform and every morph weight: clips, layers, live pose. Vertex clips leave the rest pose.
  /// An actor without a skeleton has no joints, but may have weights.
  [[nodiscard]] const animation::Pose& pose(const Actor& actor, const Shown& shown);
  /// pose(), and the matrix of each joint, by place.
  [[nodiscard]] std::span<const animation::Affine> model_from_joint(const Actor& actor, const Shown& shown);
  /// pose() and model_from_joint(), and the matrix of each entry of the skin; empty without a skin.
  [[nodiscard]] std::span<const animation::Affine> skin_matrices(const Actor& actor, const Shown& shown);
  /// What the last call of those above found on its way: the morph weights, and (not after pose()) the joints' matrices.
  [[nodiscard]] std::span<const float> last_weights() const noexcept { return pose_.weights(); }
  [[nodiscard]] std::span<const animation::Affine> last_joints() const noexcept { return model_from_joint_; }
  /// After morphing and skinning, in model space. Clips of vertices stand for the mesh as it ends up; a fade between the two
  /// kinds blends the results.
  /// @return Internal where a length of `out` is neither 0 nor 3 × the mesh's vertices
  [[nodiscard]] Status vertices(const Actor& actor, const Shown& shown, const animation::VertexTarget& out);

 private:
  [[nodiscard]] Status skinned(const Actor& actor, const Shown& shown, const animation::VertexTarget& out);
  [[nodiscard]] Status faded(const Actor& actor, const Shown& shown, const animation::VertexTarget& out);

  animation::Pose pose_;
  animation::Pose other_;
  animation::Pose rest_;
  std::vector<animation::Affine> model_from_joint_;
  std::vector<animation::Affine> skin_matrices_;
  std::vector<float> morphed_;
  std::vector<float> faded_;
};

/// Whether the mesh is to be morphed and skinned, rather than blended of keyframes' vertices alone.
[[nodiscard]] bool shows_pose(const Shown& shown) noexcept;
/// Whether it is blended of keyframes' vertices alone.
[[nodiscard]] bool shows_vertices(const Shown& shown) noexcept;

}  // namespace tweend::model
