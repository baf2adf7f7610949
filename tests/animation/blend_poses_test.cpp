#include "server/animation/blend_poses.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

#include "tests/animation/every_target.hpp"
#include "tests/animation/random_tracks.hpp"
#include "tests/animation/reference_track.hpp"

namespace tweend::animation {
namespace {

constexpr double kTolerance = 1e-6;

Pose random_pose(std::uint32_t seed, std::size_t joints, std::size_t weights = 3) {
  RandomTracks random(seed);
  Pose pose;
  pose.reset(joints, weights);
  for (std::size_t j = 0; j < joints; ++j) {
    const glm::vec4 q = random.direction();
    JointPose joint;
    joint.translation = {random.number(-1, 1), random.number(-1, 1), random.number(-1, 1)};
    joint.rotation = glm::quat(q.w, q.x, q.y, q.z);
    joint.scale = {random.number(0.5, 2), random.number(0.5, 2), random.number(-2, -0.5)};
    pose.set_joint(j, joint);
  }
  for (float& weight : pose.weights()) weight = random.number(0, 1);
  return pose;
}

glm::dvec4 xyzw(const glm::quat& q) { return {q.x, q.y, q.z, q.w}; }

void expect_near(const glm::vec3& found, const glm::dvec3& expected) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], kTolerance);
}

void expect_same_turn(const glm::quat& found, glm::dvec4 expected) {
  if (glm::dot(xyzw(found), expected) < 0.0) expected = -expected;
  EXPECT_LE(glm::length(xyzw(found) - expected), kTolerance);
}

bool same_bits(const Pose& a, const Pose& b) {
  for (std::size_t row = 0; row < kPoseRows; ++row) {
    const auto of_a = a.row(static_cast<PoseRow>(row)), of_b = b.row(static_cast<PoseRow>(row));
    if (of_a.size() != of_b.size() || std::memcmp(of_a.data(), of_b.data(), of_a.size_bytes()) != 0) return false;
  }
  return std::ranges::equal(a.weights(), b.weights());
}

void expect_identity_padding(const Pose& pose) {
  for (std::size_t row = 0; row < kPoseRows; ++row) {
    for (std::size_t j = pose.joint_count(); j < pose.stride(); ++j) {
      EXPECT_EQ(pose.row(static_cast<PoseRow>(row))[j], row < 6 ? 0.0F : 1.0F);
    }
  }
}

/// Runs `check` with poses of many sizes, with and without a mask; a mask's first joints weigh 0 and 1.
void for_many(const std::function<void(std::size_t joints, float weight, const std::vector<float>& mask)>& check) {
  RandomTracks random(9);
  for (std::size_t joints = 1; joints < 80; joints += 1 + joints / 9) {
    std::vector<float> mask;
    for (std::size_t j = 0; j < joints; ++j) mask.push_back(j % 5 < 2 ? static_cast<float>(j % 5) : random.number(0, 1));
    check(joints, random.number(0, 1), {});
    check(joints, random.number(0, 1), mask);
  }
}

class BlendPoses : public EveryTarget {};
TWEEND_ON_EVERY_TARGET(BlendPoses);

TEST_P(BlendPoses, LerpsAndSlerpsEachJointByItsWeight) {
  for_many([](std::size_t joints, float weight, const std::vector<float>& mask) {
    const Pose from = random_pose(1, joints), to = random_pose(2, joints);
    Pose found = from;
    blend_poses(to, weight, mask, found);
    for (std::size_t j = 0; j < joints; ++j) {
      const JointPose a = from.joint(j), b = to.joint(j), c = found.joint(j);
      const double w = static_cast<double>(mask.empty() ? weight : weight * mask[j]);
      expect_near(c.translation, glm::mix(glm::dvec3(a.translation), glm::dvec3(b.translation), w));
      expect_near(c.scale, glm::mix(glm::dvec3(a.scale), glm::dvec3(b.scale), w));
      expect_same_turn(c.rotation, reference::slerp(xyzw(a.rotation), xyzw(b.rotation), w));
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const float expected = mask.empty() ? std::lerp(from.weights()[i], to.weights()[i], weight) : from.weights()[i];
      EXPECT_NEAR(found.weights()[i], expected, kTolerance);
    }
    expect_identity_padding(found);
  });
}

TEST_P(BlendPoses, Weights0And1AreExact) {
  for (const std::size_t joints : {1U, 16U, 67U}) {
    const Pose from = random_pose(3, joints), to = random_pose(4, joints);
    Pose found = from;
    blend_poses(to, 0.0F, {}, found);
    EXPECT_TRUE(same_bits(found, from));
    blend_poses(to, 1.0F, {}, found);
    EXPECT_TRUE(same_bits(found, to));
    std::vector<float> mask(joints, 0.0F);
    mask.back() = 1.0F;
    found = from;
    blend_poses(to, 1.0F, mask, found);
    for (std::size_t j = 0; j + 1 < joints; ++j) EXPECT_EQ(found.joint(j), from.joint(j));
    EXPECT_EQ(found.joint(joints - 1), to.joint(joints - 1));
  }
}

class AddPose : public EveryTarget {};
TWEEND_ON_EVERY_TARGET(AddPose);

TEST_P(AddPose, AddsTheWeightedDifferenceToTheRest) {
  for_many([](std::size_t joints, float weight, const std::vector<float>& mask) {
    const Pose base = random_pose(5, joints), layer = random_pose(6, joints), rest = random_pose(7, joints);
    Pose found = base;
    add_pose(layer, rest, weight, mask, found);
    for (std::size_t j = 0; j < joints; ++j) {
      const JointPose a = base.joint(j), b = layer.joint(j), r = rest.joint(j), c = found.joint(j);
      const double w = static_cast<double>(mask.empty() ? weight : weight * mask[j]);
      expect_near(c.translation, glm::dvec3(a.translation) + w * (glm::dvec3(b.translation) - glm::dvec3(r.translation)));
      expect_near(c.scale, glm::dvec3(a.scale) * (1.0 + w * (glm::dvec3(b.scale) / glm::dvec3(r.scale) - 1.0)));
      const reference::Quaternion rest_turn(xyzw(r.rotation));
      const glm::dvec4 turn =
          (reference::Quaternion(rest_turn.w, -rest_turn.v) * reference::Quaternion(xyzw(b.rotation))).xyzw();
      const glm::dvec4 part = reference::slerp({0, 0, 0, 1}, turn, w);
      expect_same_turn(c.rotation, (reference::Quaternion(xyzw(a.rotation)) * reference::Quaternion(part)).xyzw());
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const float difference = layer.weights()[i] - rest.weights()[i];
      EXPECT_NEAR(found.weights()[i], base.weights()[i] + (mask.empty() ? weight * difference : 0.0F), kTolerance);
    }
    expect_identity_padding(found);
  });
}

TEST_P(AddPose, Weight0IsExactAndAScaleOf0AddsNothing) {
  const Pose base = random_pose(8, 20), layer = random_pose(9, 20);
  Pose rest = layer;
  Pose found = base;
  add_pose(layer, random_pose(10, 20), 0.0F, {}, found);
  EXPECT_TRUE(same_bits(found, base));
  for (std::size_t j = 0; j < 20; ++j) {
    JointPose joint = rest.joint(j);
    joint.scale = {0.0F, joint.scale.y, 0.0F};
    rest.set_joint(j, joint);
  }
  add_pose(layer, rest, 0.7F, {}, found);
  for (std::size_t j = 0; j < 20; ++j) {
    expect_near(found.joint(j).scale, base.joint(j).scale);
    expect_near(found.joint(j).translation, base.joint(j).translation);
    expect_same_turn(found.joint(j).rotation, xyzw(base.joint(j).rotation));
  }
}

TEST(Pose, HoldsWhatIsSetAndStaysAlignedInCopies) {
  Pose pose = random_pose(11, 17);
  const Pose copy = pose;
  EXPECT_TRUE(same_bits(copy, pose));
  EXPECT_EQ(copy.stride(), 32U);
  EXPECT_EQ(std::bit_cast<std::uintptr_t>(copy.row(PoseRow::Rx).data()) % 64, 0U);
  pose.reset(3, 1);
  for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(pose.joint(j), JointPose{});
  EXPECT_EQ(pose.weights()[0], 0.0F);
  expect_identity_padding(pose);
}

}  // namespace
}  // namespace tweend::animation
