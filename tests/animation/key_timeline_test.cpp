#include "server/animation/key_timeline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace tweend::animation {
namespace {

void expect_held(const KeySegment& segment, std::uint32_t key) {
  EXPECT_EQ(segment.from, key);
  EXPECT_EQ(segment.to, key);
  EXPECT_EQ(segment.u, 0.0);
}

void expect_between(const KeySegment& segment, std::uint32_t from, std::uint32_t to, double u) {
  EXPECT_EQ(segment.from, from);
  EXPECT_EQ(segment.to, to);
  EXPECT_NEAR(segment.u, u, 1e-12);
}

TEST(Locate, HoldsEachKeyExactly) {
  const std::vector<double> times_s{0.5, 0.6, 1.7, 2.0, 9.0};
  for (const bool closed : {false, true}) {
    const KeyTimeline timeline{times_s, 10.0, closed};
    for (std::uint32_t i = 0; i < times_s.size(); ++i) expect_held(locate(timeline, times_s[i]), i);
  }
}

TEST(Locate, FindsTheSegmentBetweenUnevenKeys) {
  const std::vector<double> times_s{0.0, 0.001, 1.0, 1.5, 100.0};
  const KeyTimeline timeline{times_s, 100.0, false};
  expect_between(locate(timeline, 0.0005), 0, 1, 0.5);
  expect_between(locate(timeline, 0.5), 1, 2, 0.499 / 0.999);
  expect_between(locate(timeline, 1.25), 2, 3, 0.5);
  expect_between(locate(timeline, 50.0), 3, 4, 48.5 / 98.5);
}

TEST(Locate, FindsEverySegmentOfEvenAndRandomKeys) {
  std::mt19937 random(3);
  std::exponential_distribution<double> gap(20.0);
  for (const bool even : {true, false}) {
    std::vector<double> times_s{0.0};
    while (times_s.size() < 3000)
      times_s.push_back(even ? static_cast<double>(times_s.size()) / 30.0 : times_s.back() + gap(random) + 1e-6);
    const KeyTimeline timeline{times_s, times_s.back(), false};
    for (std::uint32_t i = 0; i + 1 < times_s.size(); ++i) {
      expect_held(locate(timeline, times_s[i]), i);
      const KeySegment middle = locate(timeline, 0.5 * (times_s[i] + times_s[i + 1]));
      EXPECT_EQ(middle.from, i);
      EXPECT_EQ(middle.to, i + 1);
      const KeySegment end = locate(timeline, std::nextafter(times_s[i + 1], 0.0));
      EXPECT_EQ(end.from, i);
      EXPECT_LT(end.u, 1.0);
    }
  }
}

TEST(Locate, ClampsAnOpenClip) {
  const std::vector<double> times_s{0.5, 2.0};
  const KeyTimeline timeline{times_s, 2.5, false};
  expect_held(locate(timeline, -1.0), 0);
  expect_held(locate(timeline, 0.2), 0);
  expect_held(locate(timeline, 2.2), 1);
  expect_held(locate(timeline, 1e300), 1);
  expect_held(locate(timeline, std::numeric_limits<double>::infinity()), 1);
  expect_held(locate(timeline, std::numeric_limits<double>::quiet_NaN()), 0);
}

TEST(Locate, ClosesAClipThatStartsAt0) {
  const std::vector<double> times_s{0.0, 1.0, 3.0};
  const KeyTimeline timeline{times_s, 4.0, true};
  expect_between(locate(timeline, 3.25), 2, 0, 0.25);
  expect_held(locate(timeline, 4.0), 0);
  expect_held(locate(timeline, 5.0), 0);
  const KeySegment end = locate(timeline, std::nextafter(4.0, 0.0));
  EXPECT_EQ(end.from, 2U);
  EXPECT_LT(end.u, 1.0);
}

TEST(Locate, ClosesAClipWhoseFirstKeyIsLater) {
  const std::vector<double> times_s{0.5, 1.0, 3.0};
  const KeyTimeline timeline{times_s, 4.0, true};  // 1.5 s from the last key to the first
  expect_between(locate(timeline, 3.75), 2, 0, 0.5);
  expect_between(locate(timeline, 4.0), 2, 0, 1.0 / 1.5);
  expect_between(locate(timeline, 0.0), 2, 0, 1.0 / 1.5);
  expect_between(locate(timeline, 0.25), 2, 0, 1.25 / 1.5);
  expect_held(locate(timeline, 0.5), 0);
  EXPECT_LT(locate(timeline, std::nextafter(0.5, 0.0)).u, 1.0);
}

TEST(Locate, ClosesAClipOfTwoKeys) {
  const std::vector<double> times_s{0.0, 1.0};
  const KeyTimeline timeline{times_s, 3.0, true};
  expect_between(locate(timeline, 0.5), 0, 1, 0.5);
  expect_between(locate(timeline, 2.0), 1, 0, 0.5);
}

TEST(Locate, HoldsASingleKeyForever) {
  const std::vector<double> times_s{0.7};
  for (const bool closed : {false, true}) {
    for (const double t : {-1.0, 0.0, 0.7, 1.0, 5.0}) expect_held(locate({times_s, 2.0, closed}, t), 0);
  }
}

}  // namespace
}  // namespace tweend::animation
