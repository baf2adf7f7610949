#include <fmt/format.h>

#include <algorithm>

#include "server/commands/command_table.hpp"
#include "server/commands/pose_types.hpp"
#include "server/model/evaluate.hpp"

namespace tweend::commands {
namespace {

struct PoseSetParams {
  static constexpr std::string_view kName = "PoseSetParams";
  std::optional<std::string> scene;
  std::optional<std::string> actor;
  PoseParams pose;
  static void describe(FieldList<PoseSetParams>& f) {
    add_scene_field(f);
    add_actor_field(f);
    f.add<&PoseSetParams::pose>("pose", "By the joints' names; other joints, and what a joint leaves out, stay the player's.");
  }
};

struct PoseClearParams {
  static constexpr std::string_view kName = "PoseClearParams";
  std::optional<std::string> scene;
  std::optional<std::string> actor;
  static void describe(FieldList<PoseClearParams>& f) {
    add_scene_field(f);
    add_actor_field(f);
  }
};

enum class Space : std::uint8_t { Local, Model };

struct PoseSampleParams {
  static constexpr std::string_view kName = "PoseSampleParams";
  std::optional<std::string> scene;
  std::optional<std::string> actor;
  std::optional<std::string> clip;
  std::optional<double> time;
  std::optional<Space> space;
  static void describe(FieldList<PoseSampleParams>& f);
};

/// A joint in local space (translation, rotation, scale) or in model space (matrix).
struct SampledJoint {
  static constexpr std::string_view kName = "SampledJoint";
  std::string name;
  std::optional<glm::vec3> translation;
  std::optional<glm::quat> rotation;
  std::optional<glm::vec3> scale;
  std::optional<std::vector<float>> matrix;
  static void describe(FieldList<SampledJoint>& f) {
    using T = SampledJoint;
    f.add<&T::name>("name", "Of the joint.");
    f.add<&T::translation>("translation", "Relative to the parent, metres.");
    f.add<&T::rotation>("rotation", "Quaternion [x, y, z, w].");
    f.add<&T::scale>("scale", "Factors along x, y and z.");
    f.add<&T::matrix>("matrix", "From the joint's space to the model's, 16 numbers, column after column.");
  }
};

struct PoseSampleResult {
  static constexpr std::string_view kName = "PoseSample";
  double time = 0.0;
  std::vector<SampledJoint> joints;
  std::vector<float> weights;
  static void describe(FieldList<PoseSampleResult>& f) {
    using T = PoseSampleResult;
    f.add<&T::time>("time", "Of the clip, seconds.");
    f.add<&T::joints>("joints", "In the skeleton's order.");
    f.add<&T::weights>("weights", "Of the morph targets.");
  }
};

}  // namespace
}  // namespace tweend::commands

template <>
struct tweend::protocol::EnumNames<tweend::commands::Space> {
  static constexpr std::array<std::string_view, 2> kNames{"local", "model"};
};

namespace tweend::commands {
namespace {

void PoseSampleParams::describe(FieldList<PoseSampleParams>& f) {
  using T = PoseSampleParams;
  add_scene_field(f);
  add_actor_field(f);
  add_clip_field(f);
  f.add<&T::time>("time", "Of the clip, seconds, clamped to it; what is shown now if left out.");
  f.add<&T::space>("space", "Of each joint: local (if left out), relative to its parent; or model.");
}

/// The player of the actor that is meant, and its place in the list.
Result<std::size_t> meant_player(const std::optional<std::string>& actor, const stage::PlayersTurn& turn) {
  TWEEND_ASSIGN(const model::ActorPtr found, find_actor(turn.scene, actor));
  const auto at = std::find(turn.scene.actors.begin(), turn.scene.actors.end(), found);
  return static_cast<std::size_t>(at - turn.scene.actors.begin());
}

/// Nobody is told of a live pose but by what is shown.
using Nobody = std::vector<std::size_t>;

Result<Nobody> set_pose(const PoseSetParams& p, const stage::PlayersTurn& turn) {
  TWEEND_ASSIGN(const std::size_t player, meant_player(p.actor, turn));
  KeyedPose pose;
  TWEEND_TRY(add_given_pose(*turn.scene.actors[player], p.pose, pose));
  turn.players[player].live = std::move(pose).key();
  return Nobody{};
}

Result<Nobody> clear_pose(const PoseClearParams& p, const stage::PlayersTurn& turn) {
  TWEEND_ASSIGN(const std::size_t player, meant_player(p.actor, turn));
  turn.players[player].live = nullptr;
  return Nobody{};
}

SampledJoint local_joint(const std::string& name, const animation::JointPose& pose) {
  return {name, pose.translation, pose.rotation, pose.scale, {}};
}

SampledJoint model_joint(const std::string& name, const animation::Affine& matrix) {
  SampledJoint joint{name, {}, {}, {}, std::vector<float>()};
  const glm::mat4 columns = animation::to_mat4(matrix);
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) joint.matrix->push_back(columns[c][r]);
  }
  return joint;
}

Result<PoseSampleResult> sample_pose(const PoseSampleParams& p, const QueryContext& context) {
  const stage::SceneViewPtr view = context.view->find(scene_or_main(p.scene));
  if (!view) return no_such_scene(scene_or_main(p.scene));
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(*view->scene, p.actor));
  TWEEND_ASSIGN(const Moment moment, moment_of(actor, p.clip, p.time, view, context.now_us));
  const model::SkeletonPtr& skeleton = actor->model->skeleton;
  model::Evaluator evaluator;
  PoseSampleResult result{moment.time_s, {}, {}};
  const animation::Pose& pose = evaluator.pose(*actor, moment.shown);
  result.weights.assign(pose.weights().begin(), pose.weights().end());
  const std::size_t joints = actor->model->joint_count();
  if (p.space == Space::Model) {
    const std::span<const animation::Affine> matrices = evaluator.model_from_joint(*actor, moment.shown);
    for (std::uint32_t j = 0; j < joints; ++j) {
      result.joints.push_back(model_joint(skeleton->joints()[j].name, matrices[skeleton->place_of(j)]));
    }
  } else {
    for (std::uint32_t j = 0; j < joints; ++j) {
      result.joints.push_back(local_joint(skeleton->joints()[j].name, pose.joint(skeleton->place_of(j))));
    }
  }
  return result;
}

}  // namespace

void add_pose_commands(std::vector<Command>& t) {
  t.push_back(
      players_command<&set_pose, EmptyResult>("pose.set", "Show a live pose over the player's, in place of the last one."));
  t.push_back(players_command<&clear_pose, EmptyResult>("pose.clear", "Show the player's pose again."));
  t.push_back(
      query_command<&sample_pose>("pose.sample", Role::View, "Every joint at a time, or as shown now.", Shape::WorkerQuery));
}

}  // namespace tweend::commands
