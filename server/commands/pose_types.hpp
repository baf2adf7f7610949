#pragma once

#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/type_info.hpp"
#include "server/animation/pose.hpp"
#include "server/commands/wire_types.hpp"
#include "server/model/actor.hpp"

// Poses and skeletons as commands give them.

namespace tweend::commands {

/// What a pose says of one joint; what it leaves out, it says nothing of.
struct JointParams {
  static constexpr std::string_view kName = "JointPose";
  std::optional<glm::vec3> translation, translation_in_tangent, translation_out_tangent;
  std::optional<glm::quat> rotation;
  std::optional<std::array<double, 4>> rotation_in_tangent, rotation_out_tangent;
  std::optional<glm::vec3> scale, scale_in_tangent, scale_out_tangent;
  static void describe(FieldList<JointParams>& f);
  [[nodiscard]] Status check() const;
};
using PoseParams = protocol::Entries<JointParams>;

struct SkeletonJointParams {
  static constexpr std::string_view kName = "SkeletonJoint";
  std::string name;
  std::optional<std::string> parent;
  std::optional<glm::vec3> translation;
  std::optional<glm::quat> rotation;
  std::optional<glm::vec3> scale;
  static void describe(FieldList<SkeletonJointParams>& f);
};

struct SkeletonParams {
  static constexpr std::string_view kName = "Skeleton";
  std::vector<SkeletonJointParams> joints;
  static void describe(FieldList<SkeletonParams>& f);
};

/// @return InvalidParams with a path from `params.skeleton` on, or Limit
[[nodiscard]] Result<model::SkeletonPtr> make_skeleton(const SkeletonParams& p, const Limits& limits);

/// What is keyed, in the making.
struct KeyedPose {
  std::vector<model::KeyedValue> values;
  std::vector<model::KeyedTangents> tangents;  ///< one for each value
  bool has_tangents = false;

  /// Replaces what is said of the channel.
  void set(const animation::Channel& channel, const glm::vec4& value, const model::KeyedTangents& with = {});
  [[nodiscard]] model::PoseKeyPtr key() &&;
};

/// Sets every joint and weight to what `pose` shows, without tangents.
void add_whole_pose(const model::Model& model, const animation::Pose& pose, KeyedPose& out);
/// Sets what the command says.
/// @return InvalidParams, path "params.pose…", for joints that are not there, or without a skeleton
[[nodiscard]] Status add_given_pose(const model::Actor& actor, const PoseParams& given, KeyedPose& out);

}  // namespace tweend::commands
