#include "server/animation/key_blend.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <vector>

namespace tweend::animation {
namespace {

/// A clip with a number at each key, the definition of its value, and the library's.
struct Clip {
  std::string name;
  std::vector<double> times_s;
  double duration_s;
  bool closed;

  [[nodiscard]] KeyTimeline timeline() const { return {times_s, duration_s, closed}; }
  [[nodiscard]] double key_value(std::size_t key) const { return std::sin(2.3 * static_cast<double>(key) + 0.4) * 3.0; }

  [[nodiscard]] KeyBlend blend(double t, Interpolation mode, const CubicBezier* easing = nullptr) const {
    return blend_keys(timeline(), locate(timeline(), t), mode, easing);
  }
  [[nodiscard]] double value(double t, Interpolation mode, const CubicBezier* easing = nullptr) const {
    const KeyBlend b = blend(t, mode, easing);
    double sum = 0.0;
    for (std::uint32_t i = 0; i < b.count; ++i) sum += static_cast<double>(b.weight[i]) * key_value(b.key[i]);
    return sum;
  }
};

struct Point {
  double t;
  double x;
};

/// The keys as the definition sees them, written out: the closed clip once before and once after itself and the open one
/// with its ends repeated as far outside as their neighbours are inside.
std::vector<Point> written_out(const Clip& clip) {
  std::vector<Point> points;
  const std::size_t n = clip.times_s.size();
  if (clip.closed) {
    for (const int lap : {-2, -1, 0, 1, 2}) {
      for (std::size_t i = 0; i < n; ++i) points.push_back({clip.times_s[i] + lap * clip.duration_s, clip.key_value(i)});
    }
    return points;
  }
  const auto& t = clip.times_s;
  points.push_back({2.0 * t[0] - t[1], clip.key_value(0)});
  for (std::size_t i = 0; i < n; ++i) points.push_back({t[i], clip.key_value(i)});
  points.push_back({2.0 * t[n - 1] - t[n - 2], clip.key_value(n - 1)});
  return points;
}

double tangent(const std::vector<Point>& p, std::size_t i) { return (p[i + 1].x - p[i - 1].x) / (p[i + 1].t - p[i - 1].t); }

double reference(const Clip& clip, double t, Interpolation mode, const CubicBezier* easing = nullptr) {
  if (!clip.closed && t <= clip.times_s.front()) return clip.key_value(0);
  if (!clip.closed && t >= clip.times_s.back()) return clip.key_value(clip.times_s.size() - 1);
  const std::vector<Point> p = written_out(clip);
  std::size_t i = 1;
  while (p[i + 1].t <= t) ++i;
  const double h = p[i + 1].t - p[i].t;
  if (mode == Interpolation::Step) return p[i].x;
  double u = (t - p[i].t) / h;
  if (mode == Interpolation::Cubic) return p[i].x + (p[i + 1].x - p[i].x) * u * u * (3 - 2 * u);  // tangents 0, never eased
  if (easing != nullptr) u = ease(*easing, u);
  if (mode == Interpolation::Linear) return p[i].x + (p[i + 1].x - p[i].x) * u;
  const double m0 = h * tangent(p, i);
  const double m1 = h * tangent(p, i + 1);
  return p[i].x + u * (m0 + u * (3 * (p[i + 1].x - p[i].x) - 2 * m0 - m1 + u * (2 * (p[i].x - p[i + 1].x) + m0 + m1)));
}

std::vector<Clip> clips() {
  return {
      {"two, open", {0.0, 1.0}, 1.0, false},
      {"two, closed", {0.0, 1.0}, 3.0, true},
      {"two, closed, first later", {0.4, 1.0}, 3.0, true},
      {"three, open", {0.0, 0.3, 2.0}, 2.5, false},
      {"three, closed", {0.0, 0.3, 2.0}, 2.5, true},
      {"four, even, open", {0.0, 1.0, 2.0, 3.0}, 3.0, false},
      {"four, even, closed", {0.0, 1.0, 2.0, 3.0}, 4.0, true},
      {"five, uneven, open, first later", {0.25, 0.5, 2.0, 2.1, 5.0}, 6.0, false},
      {"five, uneven, closed, first later", {0.25, 0.5, 2.0, 2.1, 5.0}, 6.0, true},
  };
}

/// Some hundred times all over the clip, few of them on a key.
std::vector<double> instants(const Clip& clip) {
  std::vector<double> result;
  for (int i = 0; i < 337; ++i) result.push_back(clip.duration_s * i / 337.0);
  return result;
}

constexpr CubicBezier kOvershoot{0.68F, -0.6F, 0.32F, 1.6F};
constexpr Interpolation kModes[] = {Interpolation::Step, Interpolation::Linear, Interpolation::CatmullRom,
                                    Interpolation::Cubic};

TEST(BlendKeys, MatchesTheDefinitionInEveryMode) {
  for (const Clip& clip : clips()) {
    for (const Interpolation mode : kModes) {
      for (const CubicBezier* easing : {static_cast<const CubicBezier*>(nullptr), &kOvershoot}) {
        for (const double t : instants(clip)) {
          EXPECT_NEAR(clip.value(t, mode, easing), reference(clip, t, mode, easing), 2e-6) << clip.name << " at " << t;
        }
      }
    }
  }
}

TEST(BlendKeys, IsOneKeyExactlyOnAKey) {
  for (const Clip& clip : clips()) {
    for (const Interpolation mode : kModes) {
      for (std::uint32_t i = 0; i < clip.times_s.size(); ++i) {
        const KeyBlend b = clip.blend(clip.times_s[i], mode, &kOvershoot);
        EXPECT_EQ(b.count, 1U);
        EXPECT_EQ(b.key[0], i);
        EXPECT_EQ(b.weight[0], 1.0F);
        EXPECT_EQ(b.nearest, 0U);
      }
    }
  }
}

TEST(BlendKeys, WeightsSumTo1AndNameNoKeyTwice) {
  for (const Clip& clip : clips()) {
    for (const Interpolation mode : kModes) {
      for (const double t : instants(clip)) {
        const KeyBlend b = clip.blend(t, mode, &kOvershoot);
        ASSERT_GE(b.count, 1U);
        ASSERT_LE(b.count, 4U);
        ASSERT_LT(b.nearest, b.count);
        const double sum = std::accumulate(b.weight.begin(), b.weight.begin() + b.count, 0.0);
        EXPECT_NEAR(sum, 1.0, 3e-7) << clip.name << " at " << t;
        EXPECT_EQ(std::set<std::uint32_t>(b.key.begin(), b.key.begin() + b.count).size(), b.count);
        for (std::uint32_t i = 0; i < b.count; ++i) EXPECT_LT(b.key[i], clip.times_s.size());
      }
    }
  }
}

TEST(BlendKeys, IsTheFormulaWhereKeysAreEvenlySpaced) {
  const Clip clip{"", {0.0, 0.5, 1.0, 1.5}, 1.5, false};
  const double x0 = clip.key_value(0), x1 = clip.key_value(1), x2 = clip.key_value(2), x3 = clip.key_value(3);
  for (int i = 1; i < 100; ++i) {
    const double u = i / 100.0;
    const double expected =
        0.5 * (2 * x1 + (-x0 + x2) * u + (2 * x0 - 5 * x1 + 4 * x2 - x3) * u * u + (-x0 + 3 * x1 - 3 * x2 + x3) * u * u * u);
    EXPECT_NEAR(clip.value(0.5 + 0.5 * u, Interpolation::CatmullRom), expected, 1e-6) << u;
  }
}

TEST(BlendKeys, CatmullRomHasTheTangentOfTheDefinitionOnBothSidesOfEachKey) {
  for (const Clip& clip : clips()) {
    const auto points = written_out(clip);
    // A segment is a cubic, so its slope at an end follows exactly from four values in it.
    const auto slope_towards = [&](double t, double other_end) {
      const double step = (other_end - t) / 4.0;
      const auto at = [&](int i) {
        const double time = t + i * step;
        return clip.value(clip.closed ? time - std::floor(time / clip.duration_s) * clip.duration_s : time,
                          Interpolation::CatmullRom);
      };
      return (-11.0 * at(0) + 18.0 * at(1) - 9.0 * at(2) + 2.0 * at(3)) / (6.0 * step);
    };
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const double t = points[i].t;
      if (clip.closed && (t < 0.0 || t >= clip.duration_s)) continue;
      const double expected = tangent(points, i);
      constexpr double kTolerance = 2e-4;  // weights are floats
      if (clip.closed || i + 2 < points.size()) {
        EXPECT_NEAR(slope_towards(t, points[i + 1].t), expected, kTolerance) << clip.name << ", after the key at " << t;
      }
      if (clip.closed || i > 1) {
        EXPECT_NEAR(slope_towards(t, points[i - 1].t), expected, kTolerance) << clip.name << ", before the key at " << t;
      }
    }
  }
}

TEST(BlendKeys, IsContinuousOverTheSeam) {
  for (const Clip& clip : clips()) {
    if (!clip.closed) continue;
    for (const Interpolation mode : {Interpolation::Linear, Interpolation::CatmullRom}) {
      EXPECT_NEAR(clip.value(clip.duration_s - 1e-9, mode), clip.value(0.0, mode), 1e-5) << clip.name;
      EXPECT_NEAR(clip.value(clip.duration_s, mode), clip.value(0.0, mode), 1e-5) << clip.name;
    }
  }
}

TEST(BlendKeys, MergesRepeatedKeysAtOpenEnds) {
  const Clip four{"", {0.0, 1.0, 2.0, 3.0}, 3.0, false};
  EXPECT_EQ(four.blend(0.5, Interpolation::CatmullRom).count, 3U);
  EXPECT_EQ(four.blend(1.5, Interpolation::CatmullRom).count, 4U);
  EXPECT_EQ(four.blend(2.5, Interpolation::CatmullRom).count, 3U);
  const Clip two{"", {0.0, 1.0}, 2.0, false};
  EXPECT_EQ(two.blend(0.5, Interpolation::CatmullRom).count, 2U);
  const Clip two_closed{"", {0.0, 1.0}, 2.0, true};
  EXPECT_EQ(two_closed.blend(1.5, Interpolation::CatmullRom).count, 2U);
}

TEST(BlendKeys, ASingleKeyIsHeldInEveryMode) {
  for (const bool closed : {false, true}) {
    const Clip one{"", {0.5}, 2.0, closed};
    for (const Interpolation mode : kModes) {
      for (const double t : {0.0, 0.5, 1.0, 2.0}) EXPECT_EQ(one.blend(t, mode).count, 1U);
    }
  }
}

TEST(BlendKeys, StepHoldsTheKeyBeforeAndIgnoresEasing) {
  const Clip clip{"", {0.0, 1.0, 2.0}, 3.0, true};
  EXPECT_EQ(clip.blend(0.999, Interpolation::Step, &kOvershoot).key[0], 0U);
  EXPECT_EQ(clip.blend(1.0, Interpolation::Step, &kOvershoot).key[0], 1U);
  EXPECT_EQ(clip.blend(2.9, Interpolation::Step, &kOvershoot).key[0], 2U);
  EXPECT_EQ(clip.blend(2.9, Interpolation::Step, &kOvershoot).count, 1U);
}

TEST(BlendKeys, NearestIsNearestInTimeWhateverTheEasing) {
  const Clip clip{"", {0.0, 1.0}, 1.0, false};
  const CubicBezier late{1.0F, 0.0F, 1.0F, 0.0F};  // hardly moves before the end
  for (const Interpolation mode : {Interpolation::Linear, Interpolation::CatmullRom}) {
    const KeyBlend early_blend = clip.blend(0.4, mode, &late);
    EXPECT_EQ(early_blend.key[early_blend.nearest], 0U);
    const KeyBlend late_blend = clip.blend(0.6, mode, &late);
    EXPECT_EQ(late_blend.key[late_blend.nearest], 1U);
  }
}

TEST(BlendKeys, AnOvershootingEasingLeavesTheKeysRange) {
  const Clip clip{"", {0.0, 1.0}, 1.0, false};
  const KeyBlend b = clip.blend(0.2, Interpolation::Linear, &kOvershoot);
  EXPECT_GT(b.weight[0], 1.0F);
  EXPECT_LT(b.weight[1], 0.0F);
}

}  // namespace
}  // namespace tweend::animation
