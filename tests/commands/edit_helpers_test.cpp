#include "server/commands/edit_helpers.hpp"

#include <gtest/gtest.h>

namespace tweend::commands {
namespace {

model::Clip clip_with(std::vector<double> times_s, bool closed = false, std::optional<double> duration_s = {}) {
  model::Clip clip;
  clip.settings = {closed, duration_s, {}};
  for (std::size_t i = 0; i < times_s.size(); ++i)
    clip.keyframes.push_back({static_cast<model::KeyframeId>(i + 1), {}, {}, nullptr});
  clip.times_s = std::move(times_s);
  return clip;
}

TEST(CheckKeyframeTime, WithinAMicrosecondOfAnotherIsAConflict) {
  const model::Clip clip = clip_with({0.0, 1.0, 2.0});
  for (const double taken : {0.0, 1.0, 2.0, 0.9999991, 1.0000009, 1.000001, 1.999999}) {
    const Status status = check_keyframe_time(clip, taken);
    ASSERT_FALSE(status) << taken;
    EXPECT_EQ(status.error().code, ErrorCode::Conflict);
    EXPECT_EQ(status.error().path, "params.time");
  }
  for (const double free : {0.0000021, 0.5, 0.999997, 1.000003, 7.0}) EXPECT_TRUE(check_keyframe_time(clip, free)) << free;
}

TEST(CheckKeyframeTime, AKeyframeDoesNotConflictWithItself) {
  const model::Clip clip = clip_with({0.0, 1.0});
  EXPECT_TRUE(check_keyframe_time(clip, 1.0000005, 2));
  EXPECT_FALSE(check_keyframe_time(clip, 0.0000005, 2));
}

TEST(CheckKeyframeTime, AnExplicitDurationIsTheEnd) {
  EXPECT_FALSE(check_keyframe_time(clip_with({0.0}, true, 4.0), 4.0)) << "a closed clip needs time to blend back";
  EXPECT_TRUE(check_keyframe_time(clip_with({0.0}, true, 4.0), 3.999));
  EXPECT_TRUE(check_keyframe_time(clip_with({0.0}, false, 4.0), 4.0));
  const Status beyond = check_keyframe_time(clip_with({0.0}, false, 4.0), 4.1);
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().code, ErrorCode::InvalidParams);
}

TEST(CheckDuration, LiesBeyondTheLastKeyframe) {
  EXPECT_TRUE(check_duration(clip_with({0.0, 3.0}, true, 4.0)));
  EXPECT_FALSE(check_duration(clip_with({0.0, 3.0}, true, 3.0)));
  EXPECT_TRUE(check_duration(clip_with({0.0, 3.0}, false, 3.0)));
  EXPECT_FALSE(check_duration(clip_with({0.0, 3.0}, false, 2.9)));
  EXPECT_TRUE(check_duration(clip_with({}, true, 0.5)));
  EXPECT_TRUE(check_duration(clip_with({0.0, 3.0}, true)));
}

}  // namespace
}  // namespace tweend::commands
