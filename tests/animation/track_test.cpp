#include "server/animation/track.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/animation/every_target.hpp"
#include "tests/animation/random_tracks.hpp"
#include "tests/animation/reference_track.hpp"

namespace tweend::animation {
namespace {

constexpr double kTolerance = 1e-6;

struct Clip {
  std::vector<reference::Track> tracks{};
  double duration_s = 1.0;
  bool closed = false;
  std::size_t joints = 1;
  std::size_t weights = 0;

  [[nodiscard]] TrackSet packed() const {
    std::vector<TrackSource> sources;
    for (const reference::Track& track : tracks) sources.push_back(track.source());
    return {sources, duration_s, closed};
  }
};

/// What `pose` holds for a channel, as a key would.
glm::dvec4 shown(const Pose& pose, const Channel& channel) {
  if (channel.property == Property::Weight) return {pose.weights()[channel.target], 0, 0, 0};
  const JointPose joint = pose.joint(channel.target);
  const glm::quat& q = joint.rotation;
  if (channel.property == Property::Rotation) return {q.x, q.y, q.z, q.w};
  return {glm::dvec3(channel.property == Property::Scale ? joint.scale : joint.translation), 0};
}

/// How far the channel's value is off; of rotations q and −q are the same.
double error_of(const reference::Track& track, const Pose& pose, glm::dvec4 expected) {
  const glm::dvec4 found = shown(pose, track.channel);
  if (track.is_rotation() && glm::dot(found, expected) < 0.0) expected = -expected;
  if (track.channel.property == Property::Weight) expected = {expected.x, 0, 0, 0};
  if (!track.is_rotation()) expected.w = 0.0;
  const glm::dvec4 error = glm::abs(found - expected);
  return std::max({error.x, error.y, error.z, error.w});
}

/// Some channels of each property with the same times and modes, and others with their own.
Clip random_clip(std::uint32_t seed) {
  RandomTracks random(seed);
  Clip clip{.duration_s = random.uniform(0.5, 5.0), .closed = seed % 2 == 1};
  clip.joints = 1 + random.below(seed % 5 == 0 ? 300 : 40);
  clip.weights = random.below(20);
  const std::size_t shared_keys = 1 + random.below(12);
  const std::vector<double> shared_times = random.times_s(shared_keys, clip.duration_s, random.below(2) == 0);
  const std::vector<KeyMode> shared_modes = random.modes(shared_keys);
  const auto add = [&](Channel channel) {
    const std::size_t choice = random.below(4);
    if (choice == 0) return;
    if (choice == 1) {
      const std::size_t keys = 1 + random.below(8);
      clip.tracks.push_back(
          random.track(channel, random.times_s(keys, clip.duration_s, random.below(2) == 0), random.modes(keys)));
    } else {
      clip.tracks.push_back(random.track(channel, shared_times, shared_modes));
    }
  };
  for (std::uint32_t joint = 0; joint < clip.joints; ++joint) {
    for (const Property property : {Property::Scale, Property::Translation, Property::Rotation}) add({joint, property});
  }
  for (std::uint32_t weight = 0; weight < clip.weights; ++weight) add({weight, Property::Weight});
  return clip;
}

/// Times all over the clip, on both sides of it, on keys and beside them.
std::vector<double> instants(const Clip& clip, RandomTracks& random) {
  std::vector<double> times{0.0, -1.0, clip.duration_s, clip.duration_s + 1.0, std::numeric_limits<double>::quiet_NaN()};
  for (int i = 0; i < 40; ++i) times.push_back(random.uniform(0.0, clip.duration_s));
  for (int i = 0; i < 10 && !clip.tracks.empty(); ++i) {
    const reference::Track& track = clip.tracks[random.below(clip.tracks.size())];
    const double t = track.times_s[random.below(track.times_s.size())];
    times.insert(times.end(), {t, t - 1e-9, t + 1e-9});
  }
  return times;
}

/// Whether a rounding may decide which way is the short one.
bool is_ambiguous(const reference::Track& track) {
  if (!track.is_rotation()) return false;
  for (std::size_t i = 0; i < track.values.size(); ++i) {
    for (const std::size_t gap : {1U, 2U}) {  // in closed clips keys beside each other over the seam, too
      const glm::dvec4 a(track.values[i]), b(track.values[(i + gap) % track.values.size()]);
      if (std::abs(glm::dot(a, b)) < 1e-5) return true;
    }
  }
  return false;
}

class SampledTracks : public EveryTarget {};
TWEEND_ON_EVERY_TARGET(SampledTracks);

TEST_P(SampledTracks, ShowsWhatTheDefinitionSaysInRandomClipsOfAllModes) {
  std::size_t compared = 0;
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    const Clip clip = random_clip(seed);
    const TrackSet set = clip.packed();
    RandomTracks random(seed + 1000);
    Pose pose;
    pose.reset(clip.joints, clip.weights);
    for (const double t : instants(clip, random)) {
      const auto fallback = static_cast<Interpolation>(random.below(4));
      set.sample(t, fallback, pose);
      for (const reference::Track& track : clip.tracks) {
        if (is_ambiguous(track)) continue;
        const auto expected = reference::sample(track, clip.duration_s, clip.closed, t, fallback);
        ASSERT_LE(error_of(track, pose, expected.value), kTolerance / std::min(1.0, expected.length))
            << "seed " << seed << ", t " << t << ", joint " << track.channel.target << ", property "
            << static_cast<int>(track.channel.property) << ", keys " << track.times_s.size();
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 100'000U);
}

TEST_P(SampledTracks, LeavesChannelsWithoutATrackAndThePaddingAlone) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    const Clip clip = random_clip(seed);
    Pose pose;
    pose.reset(clip.joints, clip.weights);
    const auto marked = [](std::size_t row, std::size_t joint) { return 100.0F + static_cast<float>(10 * joint + row); };
    for (std::size_t row = 0; row < kPoseRows; ++row) {
      for (std::size_t j = 0; j < pose.stride(); ++j) pose.row(static_cast<PoseRow>(row))[j] = marked(row, j);
    }
    for (float& weight : pose.weights()) weight = 77.0F;
    clip.packed().sample(0.4 * clip.duration_s, Interpolation::Linear, pose);
    const auto has_track = [&](Channel channel) {
      return std::ranges::any_of(clip.tracks, [&](const auto& track) { return track.channel == channel; });
    };
    for (std::size_t row = 0; row < kPoseRows; ++row) {
      const Property property = row < 3 ? Property::Translation : row < 7 ? Property::Rotation : Property::Scale;
      for (std::size_t j = 0; j < pose.stride(); ++j) {
        const bool written = j < clip.joints && has_track({static_cast<std::uint32_t>(j), property});
        EXPECT_EQ(pose.row(static_cast<PoseRow>(row))[j] == marked(row, j), !written) << "seed " << seed;
      }
    }
    for (std::uint32_t i = 0; i < clip.weights; ++i) {
      EXPECT_EQ(pose.weights()[i] == 77.0F, !has_track({i, Property::Weight}));
    }
  }
}

TEST_P(SampledTracks, IsEachKeyBitForBitAtItsTime) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const Clip clip = random_clip(seed);
    const TrackSet set = clip.packed();
    Pose pose;
    pose.reset(clip.joints, clip.weights);
    for (const reference::Track& track : clip.tracks) {
      const std::size_t key = track.times_s.size() / 2;
      set.sample(track.times_s[key], Interpolation::CatmullRom, pose);
      glm::dvec4 expected(track.values[key]);
      if (track.channel.property == Property::Weight) expected = {expected.x, 0, 0, 0};
      if (!track.is_rotation()) expected.w = 0.0;
      EXPECT_EQ(shown(pose, track.channel), expected) << "seed " << seed;
    }
  }
}

TEST_P(SampledTracks, DoesNotDependOnTheTimeBefore) {
  const Clip clip = random_clip(5);
  const TrackSet set = clip.packed();
  RandomTracks random(1);
  Pose forward, jumping;
  forward.reset(clip.joints, clip.weights);
  jumping.reset(clip.joints, clip.weights);
  for (int i = 0; i <= 200; ++i) {
    const double t = clip.duration_s * i / 200.0;
    set.sample(t, Interpolation::Linear, forward);
    set.sample(random.uniform(0.0, clip.duration_s), Interpolation::Linear, jumping);
    set.sample(t, Interpolation::Linear, jumping);
    for (std::size_t j = 0; j < clip.joints; ++j) ASSERT_EQ(forward.joint(j), jumping.joint(j));
  }
}

TEST_P(SampledTracks, ATracksValueDoesNotDependOnItsPlaceOrItsNeighbours) {
  RandomTracks random(3);
  const std::vector<double> times = random.times_s(9, 2.0, false);
  for (const Interpolation mode :
       {Interpolation::Step, Interpolation::Linear, Interpolation::CatmullRom, Interpolation::Cubic}) {
    for (const Property property : {Property::Translation, Property::Rotation, Property::Scale}) {
      const reference::Track model = random.track({0, property}, times, {KeyMode{mode, {}}});
      Clip crowd{.duration_s = 2.0, .joints = 70};
      for (std::uint32_t joint = 0; joint < 70; ++joint) {
        crowd.tracks.push_back(model);
        crowd.tracks.back().channel.target = joint;
      }
      Clip alone{.tracks = {model}, .duration_s = 2.0};
      Pose together, single;
      together.reset(70, 0);
      single.reset(1, 0);
      for (int i = 0; i < 50; ++i) {
        const double t = random.uniform(0.0, 2.0);
        crowd.packed().sample(t, mode, together);
        alone.packed().sample(t, mode, single);
        for (std::size_t joint = 0; joint < 70; ++joint) ASSERT_EQ(together.joint(joint), single.joint(0));
      }
    }
  }
}

/// Two keys a second apart.
Clip between(const glm::vec4& from, const glm::vec4& to, KeyMode mode = {Interpolation::Linear, {}}) {
  return {.tracks = {{{0, Property::Rotation}, {0.0, 1.0}, {from, to}, {}, {}, {mode}}}};
}

TEST_P(SampledTracks, SlerpsArcsOfEveryWidth) {
  RandomTracks random(11);
  Pose pose;
  pose.reset(1, 0);
  for (int i = 0; i <= 2000; ++i) {
    const double angle = i < 1000 ? std::pow(10.0, -8.0 + 8.0 * i / 1000.0) : 3.14159 / 2 * (i - 1000) / 1000.0 * 0.99999;
    const glm::dvec4 a = glm::normalize(glm::dvec4(random.direction()));
    const glm::dvec4 other(random.direction());
    const glm::dvec4 across = glm::normalize(other - glm::dot(other, a) * a);
    const double sign = i % 3 == 0 ? -1.0 : 1.0;  // beyond a right angle on the sphere: the short way is the other
    const Clip clip = between(glm::vec4(a), glm::vec4(sign * (std::cos(angle) * a + std::sin(angle) * across)));
    const double t = random.uniform(0.0, 1.0);
    clip.packed().sample(t, Interpolation::Step, pose);
    const glm::dvec4 expected = reference::sample(clip.tracks[0], 1.0, false, t, Interpolation::Step).value;
    ASSERT_LE(error_of(clip.tracks[0], pose, expected), kTolerance) << "angle " << angle;
    ASSERT_NEAR(glm::length(shown(pose, clip.tracks[0].channel)), 1.0, 5e-7);
  }
}

TEST_P(SampledTracks, TakesEitherWayWhereBothAreAsShortAndNoneWhereThereIsNone) {
  Pose pose;
  pose.reset(1, 0);
  const Clip half_turn = between({0, 0, 0, 1}, {0, 1, 0, 0});
  half_turn.packed().sample(0.5, Interpolation::Step, pose);
  EXPECT_NEAR(std::abs(pose.joint(0).rotation.y), std::sqrt(0.5), kTolerance);
  EXPECT_NEAR(std::abs(pose.joint(0).rotation.w), std::sqrt(0.5), kTolerance);
  const glm::vec4 q = glm::normalize(glm::vec4(1, 2, 3, 4));
  const Clip same = between(q, -q);
  for (const double t : {0.1, 0.5, 0.9}) {
    same.packed().sample(t, Interpolation::Step, pose);
    EXPECT_LE(error_of(same.tracks[0], pose, glm::dvec4(q)), 1e-7);
  }
}

TEST_P(SampledTracks, FollowsAnEasingBeyondBothEnds) {
  Pose pose;
  pose.reset(1, 0);
  for (const double reach : {0.0, 1.5, 6.0, 40.0}) {
    const KeyMode mode{Interpolation::Linear, CubicBezier{0.4, -reach, 0.6, 1.0 + reach}};
    const Clip clip = between(glm::normalize(glm::vec4(1, 0, 0, 2)), glm::normalize(glm::vec4(0, 1, 1, 1)), mode);
    for (const double t : {0.05, 0.2, 0.5, 0.7, 0.93}) {
      clip.packed().sample(t, Interpolation::Step, pose);
      const glm::dvec4 expected = reference::sample(clip.tracks[0], 1.0, false, t, Interpolation::Step).value;
      EXPECT_LE(error_of(clip.tracks[0], pose, expected), kTolerance * (1.0 + reach)) << reach << " at " << t;
    }
  }
}

TEST_P(SampledTracks, CatmullRomRotationsHaveOneAngularVelocityAtEachKey) {
  RandomTracks random(21);
  for (const bool closed : {false, true}) {
    Clip clip{.duration_s = 6.0, .closed = closed};
    clip.tracks.push_back({{0, Property::Rotation}, {0.0, 1.0, 1.5, 3.0, 3.5, 5.0}, random.rotations(6, 0.8F), {}, {}, {}});
    clip.tracks[0].modes = {{Interpolation::CatmullRom, {}}};
    const TrackSet set = clip.packed();
    Pose pose;
    pose.reset(1, 0);
    const auto at = [&](double t) {
      set.sample(t, Interpolation::Step, pose);
      return shown(pose, clip.tracks[0].channel);
    };
    constexpr double kStep = 2e-3;
    for (std::size_t i = closed ? 0 : 1; i < (closed ? 6U : 5U); ++i) {
      const double t = clip.tracks[0].times_s[i];
      const auto slope = [&](double direction) {  // one-sided, of second order
        glm::dvec4 x1 = at(std::fmod(t + direction * kStep + 6.0, 6.0)),
                   x2 = at(std::fmod(t + 2 * direction * kStep + 6.0, 6.0));
        const glm::dvec4 x0 = at(t);
        if (glm::dot(x0, x1) < 0.0) x1 = -x1;
        if (glm::dot(x0, x2) < 0.0) x2 = -x2;
        return direction * (4.0 * x1 - 3.0 * x0 - x2) / (2.0 * kStep);
      };
      EXPECT_LE(glm::length(slope(1.0) - slope(-1.0)), 2e-3) << "key " << i << (closed ? ", closed" : "");
    }
  }
}

TEST_P(SampledTracks, ABlendThatLeavesNoRotationHoldsTheKey) {
  Clip clip = between({0, 0, 0, 1}, {0, 0, 0, -1}, {Interpolation::Cubic, {}});  // cubic turns nothing around
  Pose pose;
  pose.reset(1, 0);
  clip.packed().sample(0.5, Interpolation::Step, pose);
  EXPECT_EQ(shown(pose, clip.tracks[0].channel), glm::dvec4(0, 0, 0, 1));
}

TEST_P(SampledTracks, WithoutTracksChangesNothing) {
  const TrackSet set({}, 1.0, true);
  Pose pose;
  pose.reset(0, 0);
  set.sample(0.5, Interpolation::Linear, pose);
  pose.reset(2, 1);
  set.sample(0.5, Interpolation::Linear, pose);
  EXPECT_EQ(pose.joint(1), JointPose{});
}

}  // namespace
}  // namespace tweend::animation
