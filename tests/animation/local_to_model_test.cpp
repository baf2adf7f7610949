#include "server/animation/local_to_model.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <vector>

#include "tests/animation/every_target.hpp"
#include "tests/animation/random_tracks.hpp"

namespace tweend::animation {
namespace {

struct Skeleton {
  std::vector<std::int32_t> parents;
  Pose pose;
};

/// @param reach  how many joints back a parent may stand; every `roots`th joint is a root
Skeleton random_skeleton(std::uint32_t seed, std::size_t joints, std::size_t reach, std::size_t roots) {
  RandomTracks random(seed);
  Skeleton skeleton;
  skeleton.pose.reset(joints, 0);
  for (std::size_t j = 0; j < joints; ++j) {
    const bool is_root = j % roots == 0;
    skeleton.parents.push_back(is_root ? -1 : static_cast<std::int32_t>(j - 1 - random.below(std::min(reach, j))));
    const glm::vec4 q = random.direction();
    JointPose joint;
    joint.translation = {random.number(-1, 1), random.number(-1, 1), random.number(-1, 1)};
    joint.rotation = glm::quat(q.w, q.x, q.y, q.z);
    joint.scale = {random.number(0.8, 1.2), random.number(0.8, 1.2), random.number(-1.1, 1.1)};
    skeleton.pose.set_joint(j, joint);
  }
  return skeleton;
}

std::vector<glm::dmat4> reference(const Skeleton& skeleton) {
  std::vector<glm::dmat4> model;
  for (std::size_t j = 0; j < skeleton.parents.size(); ++j) {
    const JointPose joint = skeleton.pose.joint(j);
    const glm::dmat4 local = glm::translate(glm::dmat4(1.0), glm::dvec3(joint.translation)) *
                             glm::mat4_cast(glm::dquat(joint.rotation)) * glm::scale(glm::dmat4(1.0), glm::dvec3(joint.scale));
    const std::int32_t parent = skeleton.parents[j];
    model.push_back(parent < 0 ? local : model[static_cast<std::size_t>(parent)] * local);
  }
  return model;
}

void expect_near(const Affine& found, const glm::dmat4& expected, double tolerance, std::size_t joint) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      ASSERT_NEAR(found.rows[static_cast<std::size_t>(row)][column], expected[column][row], tolerance) << "joint " << joint;
    }
  }
}

class LocalToModel : public EveryTarget {};
TWEEND_ON_EVERY_TARGET(LocalToModel);

TEST_P(LocalToModel, IsTheProductOfAllMatricesAboveForAnyNumberOfJoints) {
  for (std::size_t joints = 1; joints <= 300; joints += joints < 70 ? 1 : 23) {
    const Skeleton skeleton = random_skeleton(static_cast<std::uint32_t>(joints), joints, 8, 40);
    std::vector<Affine> found(joints);
    local_to_model(skeleton.parents, skeleton.pose, found);
    const auto expected = reference(skeleton);
    for (std::size_t j = 0; j < joints; ++j) expect_near(found[j], expected[j], 1e-5, j);
  }
}

TEST_P(LocalToModel, FollowsAChainOfAllJoints) {
  const Skeleton chain = random_skeleton(1, 200, 1, 1000);
  std::vector<Affine> found(200);
  local_to_model(chain.parents, chain.pose, found);
  const auto expected = reference(chain);
  for (std::size_t j = 0; j < 200; ++j) {
    double size = 1.0;
    for (int column = 0; column < 4; ++column) size = std::max(size, glm::length(expected[j][column]));
    expect_near(found[j], expected[j], 1e-5 * size, j);
  }
}

TEST_P(LocalToModel, TakesOnlyRootsAndNothingAtAll) {
  const Skeleton roots = random_skeleton(2, 33, 1, 1);
  std::vector<Affine> found(33);
  local_to_model(roots.parents, roots.pose, found);
  const auto expected = reference(roots);
  for (std::size_t j = 0; j < 33; ++j) expect_near(found[j], expected[j], 1e-6, j);
  Pose none;
  none.reset(0, 0);
  local_to_model({}, none, {});
}

TEST_P(LocalToModel, TheSameJointComesOutTheSameInAnyLane) {
  Skeleton skeleton = random_skeleton(3, 40, 1, 1);
  for (std::size_t j = 1; j < 40; ++j) skeleton.pose.set_joint(j, skeleton.pose.joint(0));
  std::vector<Affine> found(40);
  local_to_model(skeleton.parents, skeleton.pose, found);
  for (std::size_t j = 1; j < 40; ++j) EXPECT_EQ(found[j], found[0]);
}

TEST(Affine, IsTheMatrixWithoutItsLastRow) {
  const glm::mat4 a(1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 10, 0, 11, 12, 13, 1);
  const glm::mat4 b(0.5F, 1, -1, 0, 2, 0, 1, 0, -3, 1, 1, 0, 4, 5, 6, 1);
  EXPECT_EQ(to_mat4(to_affine(a)), a);
  EXPECT_EQ(to_mat4(multiply(to_affine(a), to_affine(b))), a * b);
  EXPECT_EQ(to_mat4(Affine{}), glm::mat4(1.0F));
}

}  // namespace
}  // namespace tweend::animation
