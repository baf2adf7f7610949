#include "server/animation/interpolation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace tweend::animation {
namespace {

double bezier(double c1, double c2, double s) {
  const double r = 1.0 - s;
  return 3.0 * r * r * s * c1 + 3.0 * r * s * s * c2 + s * s * s;
}

/// The definition, solved by nothing but bisection.
double reference_ease(const CubicBezier& curve, double u) {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (bezier(static_cast<double>(curve.x1), static_cast<double>(curve.x2), middle) < u ? low : high) = middle;
  }
  return bezier(static_cast<double>(curve.y1), static_cast<double>(curve.y2), 0.5 * (low + high));
}

constexpr std::array kCurves{
    CubicBezier{0.25F, 0.1F, 0.25F, 1.0F},                                          // CSS ease
    CubicBezier{0.42F, 0.0F, 1.0F, 1.0F},                                           // ease-in
    CubicBezier{0.0F, 0.0F, 0.58F, 1.0F},                                           // ease-out
    CubicBezier{0.42F, 0.0F, 0.58F, 1.0F},                                          // ease-in-out
    CubicBezier{0.68F, -0.6F, 0.32F, 1.6F},                                         // overshoots on both sides
    CubicBezier{0.0F, 1.0F, 0.0F, 1.0F},                                            // slope of x is 0 at the start
    CubicBezier{1.0F, 0.0F, 1.0F, 0.0F},                                            // and at the end
    CubicBezier{0.0F, 1.0F, 1.0F, 0.0F},    CubicBezier{0.99F, 0.3F, 0.01F, 0.7F},  // nearly 0 in the middle
};

TEST(Ease, MatchesBisectionEverywhere) {
  for (const CubicBezier& curve : kCurves) {
    for (int i = 1; i < 1000; ++i) {
      const double u = i / 1000.0;
      EXPECT_NEAR(ease(curve, u), reference_ease(curve, u), 1e-7) << curve.x1 << ' ' << curve.x2 << " at " << u;
    }
  }
}

TEST(Ease, MatchesBisectionCloseToTheEnds) {
  for (const CubicBezier& curve : kCurves) {
    for (const double u : {1e-12, 1e-9, 1e-6, 1.0 - 1e-6, 1.0 - 1e-9, 1.0 - 1e-12}) {
      EXPECT_NEAR(ease(curve, u), reference_ease(curve, u), 1e-7) << curve.x1 << ' ' << curve.x2 << " at " << u;
    }
  }
}

TEST(Ease, SolvesTheCurveThatStandsStillInTheMiddle) {
  // x(s) = ½ + 4(s − ½)³: at ½ + e the parameter is known to no better than the cube root of e's rounding.
  const CubicBezier curve{1.0F, 0.0F, 0.0F, 1.0F};
  for (int i = 1; i < 1000; ++i) {
    const double u = i / 1000.0;
    EXPECT_NEAR(ease(curve, u), reference_ease(curve, u), i == 500 ? 1e-4 : 1e-7) << u;
  }
}

TEST(Ease, StartsAt0AndEndsAt1Exactly) {
  for (const CubicBezier& curve : kCurves) {
    EXPECT_EQ(ease(curve, 0.0), 0.0);
    EXPECT_EQ(ease(curve, 1.0), 1.0);
  }
}

TEST(Ease, ClampsWhatLiesOutside) {
  EXPECT_EQ(ease(kCurves[0], -0.5), 0.0);
  EXPECT_EQ(ease(kCurves[0], 1.5), 1.0);
  EXPECT_EQ(ease(kCurves[0], std::numeric_limits<double>::quiet_NaN()), 0.0);
}

TEST(Ease, LeavesULinearOnTheDiagonal) {
  for (const CubicBezier& curve : {CubicBezier{0.0F, 0.0F, 1.0F, 1.0F}, CubicBezier{0.25F, 0.25F, 0.75F, 0.75F}}) {
    for (int i = 0; i <= 100; ++i) EXPECT_NEAR(ease(curve, i / 100.0), i / 100.0, 1e-12);
  }
}

TEST(Ease, OvershootsWhereTheCurveDoes) {
  const CubicBezier back{0.68F, -0.6F, 0.32F, 1.6F};
  EXPECT_LT(ease(back, 0.2), 0.0);
  EXPECT_GT(ease(back, 0.8), 1.0);
}

TEST(Ease, NeverFallsWhereYDoesNot) {
  double before = 0.0;
  for (int i = 0; i <= 10'000; ++i) {
    const double y = ease(kCurves[0], i / 10'000.0);
    EXPECT_GE(y, before);
    before = y;
  }
}

}  // namespace
}  // namespace tweend::animation
