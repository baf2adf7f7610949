#include "server/animation/pose.hpp"

namespace tweend::animation {
namespace {

constexpr std::size_t vectors_for(std::size_t floats) { return (floats + kPoseLanes - 1) / kPoseLanes; }

constexpr bool is_one_at_rest(std::size_t row) { return row >= static_cast<std::size_t>(PoseRow::Rw); }

}  // namespace

void Pose::reset(std::size_t joint_count, std::size_t weight_count) {
  const std::size_t vectors = vectors_for(joint_count);
  joint_count_ = joint_count;
  stride_ = vectors * kPoseLanes;
  rows_.resize(kPoseRows * vectors);
  for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i].lane.fill(is_one_at_rest(i / vectors) ? 1.0F : 0.0F);
  weight_count_ = weight_count;
  weights_.assign(vectors_for(weight_count), Lanes());
}

void Pose::assign(const Pose& joints, std::size_t weight_count) {
  joint_count_ = joints.joint_count_;
  stride_ = joints.stride_;
  rows_ = joints.rows_;
  weight_count_ = weight_count;
  weights_.assign(vectors_for(weight_count), Lanes());
}

JointPose Pose::joint(std::size_t joint) const noexcept {
  const auto at = [&](PoseRow wanted) { return row(wanted)[joint]; };
  return {{at(PoseRow::Tx), at(PoseRow::Ty), at(PoseRow::Tz)},
          {at(PoseRow::Rw), at(PoseRow::Rx), at(PoseRow::Ry), at(PoseRow::Rz)},
          {at(PoseRow::Sx), at(PoseRow::Sy), at(PoseRow::Sz)}};
}

void Pose::set_joint(std::size_t joint, const JointPose& pose) noexcept {
  const std::array<float, kPoseRows> values{pose.translation.x, pose.translation.y, pose.translation.z, pose.rotation.x,
                                            pose.rotation.y,    pose.rotation.z,    pose.rotation.w,    pose.scale.x,
                                            pose.scale.y,       pose.scale.z};
  for (std::size_t i = 0; i < kPoseRows; ++i) row(static_cast<PoseRow>(i))[joint] = values[i];
}

}  // namespace tweend::animation
