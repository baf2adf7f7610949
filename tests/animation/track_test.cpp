#include "server/animation/track.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace tweend::animation {
namespace {

TEST(TrackSet, SlerpsTheShortWayAndLeavesOtherChannelsAlone) {
  const std::array times{0.0, 1.0};
  const float half = std::sqrt(0.5F);
  const std::array values{glm::vec4(0, 0, 0, 1), glm::vec4(0, 0, -half, -half)};  // a quarter turn about z, the other sign
  const std::array modes{KeyMode{Interpolation::Linear, {}}};
  const TrackSet set(std::array{TrackSource{{1, Property::Rotation}, times, values, {}, {}, modes}}, 1.0, false);
  Pose pose;
  pose.reset(3, 0);
  pose.set_joint(0, {.translation = {1, 2, 3}});
  pose.set_joint(1, {.translation = {4, 5, 6}});
  set.sample(0.5, Interpolation::Step, pose);
  EXPECT_EQ(pose.joint(0), (JointPose{.translation = {1, 2, 3}}));
  EXPECT_EQ(pose.joint(1).translation, glm::vec3(4, 5, 6));
  EXPECT_NEAR(pose.joint(1).rotation.w, std::cos(M_PI / 8), 1e-6);
  EXPECT_NEAR(pose.joint(1).rotation.z, std::sin(M_PI / 8), 1e-6);
}

TEST(TrackSet, IsEachKeyExactlyAtItsTime) {
  const std::array times{0.5, 0.75, 2.0};
  const std::array values{glm::vec4(1, 2, 3, 0), glm::vec4(4, 5, 6, 0), glm::vec4(7, 8, 9, 0)};
  const std::array modes{KeyMode{Interpolation::Cubic, {}}};
  const TrackSet set(std::array{TrackSource{{0, Property::Scale}, times, values, {}, values, modes}}, 2.5, true);
  Pose pose;
  pose.reset(1, 0);
  for (std::size_t i = 0; i < times.size(); ++i) {
    set.sample(times[i], Interpolation::Linear, pose);
    EXPECT_EQ(pose.joint(0).scale, glm::vec3(values[i]));
  }
}

}  // namespace
}  // namespace tweend::animation
