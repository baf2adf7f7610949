#include "server/animation/interpolation.hpp"

#include <cmath>

namespace tweend::animation {
namespace {

/// One coordinate of the curve, 3(1−s)²s·c1 + 3(1−s)s²·c2 + s³, in powers of the curve parameter s.
struct Polynomial {
  Polynomial(double c1, double c2) : a(1.0 - 3.0 * c2 + 3.0 * c1), b(3.0 * c2 - 6.0 * c1), c(3.0 * c1) {}
  [[nodiscard]] double at(double s) const { return ((a * s + b) * s + c) * s; }
  [[nodiscard]] double slope(double s) const { return (3.0 * a * s + 2.0 * b) * s + c; }
  double a;
  double b;
  double c;
};

/// The s in [0, 1] with x(s) = u. x never falls, so [low, high] always holds the answer; Newton's step is taken where
/// it stays inside, and bisection otherwise (the slope is 0 at an end where x1 = 0, and in the middle for x1 = 1, x2 = 0).
double parameter_at(const Polynomial& x, double u) {
  constexpr int kMaxSteps = 64;  // bisection alone would be down to one unit in the last place by then
  constexpr double kClose = 1e-14;
  double low = 0.0;
  double high = 1.0;
  double s = u;
  for (int step = 0; step < kMaxSteps; ++step) {
    const double error = x.at(s) - u;
    if (error == 0.0) return s;
    (error > 0.0 ? high : low) = s;
    double next = s - error / x.slope(s);
    const bool inside = next > low && next < high;  // false for NaN and infinity too
    if (!inside) next = 0.5 * (low + high);
    const double moved = std::abs(next - s);
    s = next;
    if (moved < kClose) return s;
  }
  return s;
}

}  // namespace

double ease(const CubicBezier& curve, double u) noexcept {
  if (!(u > 0.0)) return 0.0;
  if (u >= 1.0) return 1.0;
  const Polynomial x(static_cast<double>(curve.x1), static_cast<double>(curve.x2));
  const Polynomial y(static_cast<double>(curve.y1), static_cast<double>(curve.y2));
  return y.at(parameter_at(x, u));
}

}  // namespace tweend::animation
